"""Frequencies of another program compared with the candidate discretisations and with the exact beam of a scene."""

from itertools import product
from typing import Any, get_args

import msgspec
import numpy as np

from verify.analysis.comparison import LEAST_MAC, LOW_MAC, mac, node_weights, pair_modes
from verify.arrays import Array, Indices
from verify.compare.candidates import CHAIN, ELEMENTS, EULER, EXACT, Candidate, candidates, frequencies_hz
from verify.compare.fit import TOLERANCE, Data, identify, spectrum
from verify.compare.reading import FrequencyList, ModeShapes
from verify.compare.report import Entry, result_of, tables_of
from verify.errors import InputError
from verify.options import Support
from verify.problem.beam import Beam
from verify.report.result import Result
from verify.validation import check_whole

RIGID = 3e-3
"""Of the next frequency: smaller leading ones are rigid motions, unless the beam has such a gap."""
SPARE = 4
"""Modes above those of a list among which shapes are paired."""
ERRORS = (1e-2, 1e-3)
"""For which N is required."""


class Options(msgspec.Struct, frozen=True, kw_only=True):
    """What is compared, and how."""

    count: int | None = None
    """N of the model; None: any."""
    kind: str | None = None
    """'segments' or 'elements'; None: any."""
    mode: int | None = None
    """For which N is required; None: the last of the list."""
    within: float | None = None
    """Largest relative error against the exact beam; None: any."""
    theory: str = EULER
    """Of the exact beam."""


def compare(
    scene: Any, given: FrequencyList, shapes: ModeShapes | None = None, options: Options | None = None
) -> Result:
    """Identify the discretisation behind frequencies of the scene's beam and their errors. Raises InputError.

    `shapes`, one for each frequency, say which modes they are. `data["passed"]` of the result is the acceptance.
    """
    beam, options = scene.beam, options or Options()
    for field in ("count", "mode"):
        if getattr(options, field) is not None:
            check_whole(field, getattr(options, field), 1)
    if shapes is not None and len(shapes.values) != len(given.hertz):
        raise InputError(f"modes = {len(shapes.values)} shapes for {len(given.hertz)} frequencies: give one for each")
    if shapes is None and (np.diff(given.hertz) < 0.0).any():
        raise InputError(f"{given.source}: frequencies do not rise: sort them, or give the shapes of the modes")
    exact = Candidate(model=EXACT, theory=options.theory)
    n = max(len(given.hertz), *(given.numbers or (0,))) + SPARE
    exact_hz = frequencies_hz(exact, beam, None, n)
    rigid = _rigid(given, exact_hz)
    kept = np.arange(rigid, len(given.hertz))
    entries, modes, likeness, paired = _paired(beam, given, shapes, kept)
    data = Data(
        beam=beam,
        logs=np.log(given.hertz[kept]),
        rounding=given.rounding[kept],
        members=candidates(beam, options.kind),
        entries=entries,
        modes=modes,
        ordered=not paired,
        count=options.count,
    )
    found = identify(data)
    rows = [
        Entry(
            int(kept[e]) + 1,
            int(m) + 1,
            float(given.hertz[kept[e]]),
            float(exact_hz[m]),
            None if likeness is None else float(likeness[i]),
        )
        for i, (e, m) in enumerate(zip(entries, modes, strict=True))
    ]
    warnings = []
    if rigid != beam.rigid_motions and rigid:
        warnings.append(f"The list starts with {rigid} rigid motions, the beam of the scene has {beam.rigid_motions}.")
    if (np.diff(entries[np.argsort(modes, kind="stable")]) < 0).any():
        warnings.append("Frequencies are not in the order of the modes: see the column entry.")
    if likeness is not None and (unlike := len(kept) - int((likeness >= LOW_MAC).sum())):
        warnings.append(
            f"{unlike} of the shapes are hardly modes of the beam (MAC below {LOW_MAC}): check beam.supports."
        )
    if found.status == "unknown" and (supports := _other_supports(beam, data.logs[entries], modes)):
        warnings.append(f"The lower modes are those of a beam with other supports: {'-'.join(supports)}.")
    mode = options.mode or max(row.mode for row in rows)
    sized = [] if found.status == "unknown" else _worth_sizing(beam, found.best.candidate)
    required = [(one, mode, _required(beam, one, mode, max(mode, data.n_modes))) for one in sized]
    tables, passed = tables_of(data, found, rows, required, options.within, len(warnings))
    about = {"scene": scene.name, "source": given.source, "unit": given.unit, "passed": passed}
    return result_of(beam, found, rows, tables, warnings, **about)


def _rigid(given: FrequencyList, exact_hz: Array) -> int:
    """How many leading entries are rigid motions. Raises InputError where all are."""
    hertz, rigid = given.hertz, 0
    for k in range(min(len(hertz), 7) - 1, 0, -1):
        gap = min(4.0 * exact_hz[k - 1] / exact_hz[k], 1.0)
        if hertz[:k].max() == 0.0 or hertz[:k].max() < RIGID * gap * hertz[k]:
            rigid = k
            break
    if not hertz[rigid:].all():
        raise InputError(f"{given.source} has no elastic mode among zeros: give their frequencies")
    return rigid


def _paired(
    beam: Beam, given: FrequencyList, shapes: ModeShapes | None, kept: Indices
) -> tuple[Indices, Indices, Array | None, bool]:
    """(entries (k,) of those kept, their modes (k,) from 0, MAC (k,), whether by more than the order)."""
    order = np.arange(len(kept))
    if shapes is not None:
        modes, likeness = pair_shapes(beam, shapes.x, shapes.values[kept])
        like = likeness >= LEAST_MAC
        return order[like], modes[like], likeness[like], True
    if given.numbers is not None:
        shift = 1 + (len(given.hertz) - len(kept) if given.numbers[0] == 1 else 0)
        modes = np.array(given.numbers)[kept] - shift
        return order, modes, None, bool((modes != order).any())
    return order, order, None, False


def pair_shapes(beam: Beam, x: Array, values: Array) -> tuple[Indices, Array]:
    """(modes from 0 (k,), MAC (k,)) of shapes (k, len(x)) of largest sum of MAC. Raises InputError for none."""
    scaled, weights = values / abs(values).max(axis=1, keepdims=True), np.sqrt(node_weights(x))
    n = max(len(values), min(len(values) + SPARE, len(x) - 2))
    modes, likeness = pair_modes(mac(scaled * weights, exact_shapes(beam, n, x) * weights))
    if likeness.max() < LEAST_MAC:
        raise InputError(f"modes: no shape is one of the beam's (MAC {likeness.max():.2f}): check x and beam.supports")
    return modes, likeness


def exact_shapes(beam: Beam, n_modes: int, x: Array) -> Array:
    """Mode shapes of the exact beam at x, (n_modes, len(x)); of fine elements where no exact ones are known."""
    from verify.linear.registry import MODELS

    try:
        return np.asarray(MODELS[EXACT].build(beam).modes(n_modes).deflection(x))
    except InputError:
        fine = max(10 * n_modes, 8 * len(beam.pieces))
        return np.asarray(MODELS[ELEMENTS].build(beam, fine).modes(n_modes).deflection(x))


def _other_supports(beam: Beam, logs: Array, modes: Indices) -> tuple[str, ...]:
    """Supports with which the exact beam has the lower half of the frequencies; empty if its own or none have them."""
    low = modes < max(len(logs) // 2, 2)
    for supports in (beam.supports, *product(get_args(Support), repeat=2)):
        other = msgspec.structs.replace(beam, supports=supports)
        try:
            exact = np.log(frequencies_hz(Candidate(model=EXACT), other, None, int(modes[low].max(initial=0)) + 1))
        except InputError:  # for example a beam that has buckled
            continue
        if low.sum() > 1 and abs(logs[low] - exact[modes[low]]).max() < 20.0 * TOLERANCE:
            return () if supports == beam.supports else supports
    return ()


def _worth_sizing(beam: Beam, best: Candidate) -> list[Candidate]:
    """The best candidate, if it has parts, and the most accurate of its kind."""
    if not best.sized:
        return []
    if best.model == CHAIN:
        wall = "gregory" if "clamped" in beam.supports else None
        joints = "tensioned" if beam.tension else "series"
        accurate = Candidate(model=CHAIN, mass="links", wall=wall, joints=joints, theory=best.theory)
    else:
        accurate = Candidate(model=ELEMENTS, mass="consistent", theory=best.theory)
    return [best, *[accurate] * (accurate != best)]


def _required(beam: Beam, candidate: Candidate, mode: int, n_modes: int) -> tuple[int | None, ...]:
    """N from which on larger ones keep each of ERRORS at a mode, by interpolation and solves; None beyond LARGEST."""
    exact = float(frequencies_hz(Candidate(model=EXACT, theory=candidate.theory), beam, None, mode)[-1])
    sizes, logs = spectrum(beam, candidate, n_modes, (None,))
    counts: list[int | None] = []
    for error in ERRORS:

        def within(size: int, error: float = error) -> bool:
            hertz = frequencies_hz(candidate, beam, size, n_modes)
            return len(hertz) >= mode and abs(float(hertz[mode - 1]) / exact - 1.0) <= error

        failing = np.flatnonzero(~(abs(np.expm1(logs[:, mode - 1] - np.log(exact))) <= error))
        if len(failing) and failing[-1] + 1 == len(sizes):
            counts.append(None)
            continue
        low, high = (int(sizes[failing[-1]]), int(sizes[failing[-1] + 1])) if len(failing) else (0, int(sizes[0]))
        step = 1
        while not within(high):
            low, high, step = high, high + step, 2 * step
        while low > 0 and within(low):
            high, low, step = low, max(low - step, 0), 2 * step
        while high - low > 1:
            middle = (high + low) // 2
            high, low = (middle, low) if within(middle) else (high, middle)
        counts.append(high)
    return tuple(counts)
