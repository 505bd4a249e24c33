"""Comparison of frequencies from another program with candidate discretisations and the exact beam of a scene."""

from itertools import product
from typing import Any, get_args

import msgspec
import numpy as np

from verify.analysis.comparison import LEAST_MAC, LOW_MAC, mac, node_weights, pair_modes
from verify.arrays import Array, Indices
from verify.compare.candidates import CHAIN, ELEMENTS, EULER, EXACT, Candidate, candidates, frequencies_hz
from verify.compare.fit import TOLERANCE, Data, identify, spectrum
from verify.compare.reading import FrequencyList, ModeShapes
from verify.compare.report import Entry, result_of
from verify.errors import InputError
from verify.options import Support
from verify.problem.beam import Beam
from verify.report.result import Result
from verify.validation import check_integer

RIGID = 3e-3
"""Fraction of the next frequency below which leading ones are rigid-body motions, unless the beam has such a gap."""
SPARE = 4
"""Number of modes above those of a list for the pairing of shapes."""
ERRORS = (1e-2, 1e-3)
"""Errors for which the required N is computed."""


class Options(msgspec.Struct, frozen=True, kw_only=True):
    """Options of a comparison; None: any, for `mode` the last of the list.

    `count`: N of the model. `kind`: 'segments' or 'elements'. `mode`: mode for the required N. `within`: tolerance of
    the relative error against the exact beam. `theory`: theory of the exact beam.
    """

    count: int | None = None
    kind: str | None = None
    mode: int | None = None
    within: float | None = None
    theory: str = EULER


def compare(
    scene: Any, listed: FrequencyList, shapes: ModeShapes | None = None, options: Options | None = None
) -> Result:
    """Identify the discretisation behind frequencies of the scene's beam and their errors. Raises InputError.

    `shapes`, one per frequency, identify the modes. `data["passed"]` of the result is the acceptance.
    """
    beam, options, hertz = scene.beam, options or Options(), listed.hertz
    for field in ("count", "mode"):
        if getattr(options, field) is not None:
            check_integer(field, getattr(options, field), 1)
    if shapes is not None and len(shapes.values) != len(hertz):
        raise InputError(f"modes = {len(shapes.values)} shapes for {len(hertz)} frequencies: give one for each")
    if shapes is None and (np.diff(hertz) < 0.0).any():
        raise InputError(f"{listed.source}: frequencies do not ascend: sort them, or give the shapes of the modes")
    n = max(len(hertz), *(listed.numbers or (0,))) + SPARE
    exact_hz, rigid = frequencies_hz(Candidate(model=EXACT, theory=options.theory), beam, None, n), 0
    for k in range(min(len(hertz), 7) - 1, 0, -1):
        gap = min(4.0 * exact_hz[k - 1] / exact_hz[k], 1.0)
        if hertz[:k].max() == 0.0 or hertz[:k].max() < RIGID * gap * hertz[k]:
            rigid = k
            break
    if not hertz[rigid:].all():
        raise InputError(f"{listed.source} has zeros but no elastic mode: give elastic frequencies")
    entries = modes = np.arange(len(hertz) - rigid)
    likeness, ordered = None, shapes is None
    if shapes is not None:
        paired, macs = pair_shapes(beam, shapes.x, shapes.values[rigid:])
        entries = np.flatnonzero(macs >= LEAST_MAC)
        modes, likeness = paired[entries], macs[entries]
    elif listed.numbers is not None:
        modes = np.array(listed.numbers)[rigid:] - 1 - (rigid if listed.numbers[0] == 1 else 0)
        ordered = bool((modes == entries).all())
    data = Data(
        beam=beam,
        logs=np.log(hertz[rigid:]),
        rounding=listed.rounding[rigid:],
        members=candidates(beam, options.kind),
        entries=entries,
        modes=modes,
        ordered=ordered,
        count=options.count,
    )
    fits = identify(data)
    macs = np.full(len(modes), None) if likeness is None else likeness
    rows = [
        Entry(int(e) + rigid + 1, int(m) + 1, float(hertz[e + rigid]), float(exact_hz[m]), like)
        for e, m, like in zip(entries, modes, macs.tolist(), strict=True)
    ]
    disorder = (np.diff(entries[np.argsort(modes, kind="stable")]) < 0).any()
    unlike = 0 if likeness is None else len(hertz) - rigid - int((likeness >= LOW_MAC).sum())
    supports = _other_supports(beam, data.logs[entries], modes) if fits.status == "unknown" else ()
    messages = {
        f"The list starts with {rigid} rigid-body motions, the beam of the scene has {beam.rigid_motions}.": rigid
        and rigid != beam.rigid_motions,
        "Frequencies are not in the order of the modes: see the column entry.": disorder,
        f"{unlike} of the shapes have a MAC below {LOW_MAC} with all modes of the beam: check beam.supports.": unlike,
        f"The lower modes are those of a beam with other supports: {'-'.join(supports)}.": supports,
    }
    warnings = [text for text, holds in messages.items() if holds]
    mode = options.mode or max(row.mode for row in rows)
    sized: list[Candidate] = []
    if fits.status != "unknown" and (best := fits.best.candidate).sized:  # and the most accurate of its kind
        wall, joints = "gregory" if "clamped" in beam.supports else None, "tensioned" if beam.tension else "series"
        chain = Candidate(model=CHAIN, mass="links", wall=wall, joints=joints, theory=best.theory)
        accurate = Candidate(model=ELEMENTS, mass="consistent", theory=best.theory)
        sized = list(dict.fromkeys([best, chain if best.model == CHAIN else accurate]))
    required = [(one, mode, *_required(beam, one, mode, max(mode, data.n_modes))) for one in sized]
    return result_of(scene.name, listed, data, fits, rows, required, warnings, options.within)


def pair_shapes(beam: Beam, x: Array, values: Array) -> tuple[Indices, Array]:
    """(modes from 0 (k,), MAC (k,)) of shapes (k, len(x)), paired for the largest sum of MAC. Raises InputError."""
    scaled, weights = values / abs(values).max(axis=1, keepdims=True), np.sqrt(node_weights(x))
    n = max(len(values), min(len(values) + SPARE, len(x) - 2))
    modes, likeness = pair_modes(mac(scaled * weights, exact_shapes(beam, n, x) * weights))
    if likeness.max() < LEAST_MAC:
        raise InputError(f"modes: no shape is a mode of the beam (MAC {likeness.max():.2f}), check x and beam.supports")
    return modes, likeness


def exact_shapes(beam: Beam, n_modes: int, x: Array) -> Array:
    """Mode shapes of the exact beam at x, (n_modes, len(x)); those of fine elements if it has none."""
    from verify.linear.registry import MODELS

    try:
        return np.asarray(MODELS[EXACT].build(beam).modes(n_modes).deflection(x))
    except InputError:
        fine = max(10 * n_modes, 8 * len(beam.pieces))
        return np.asarray(MODELS[ELEMENTS].build(beam, fine).modes(n_modes).deflection(x))


def _other_supports(beam: Beam, logs: Array, modes: Indices) -> tuple[str, ...]:
    """Other supports with which the exact beam has the lower half of the frequencies; empty if none."""
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


def _required(beam: Beam, candidate: Candidate, mode: int, n_modes: int) -> tuple[int | None, ...]:
    """Required N of a mode for each of ERRORS, by interpolation and steps of one; None beyond LARGEST."""
    exact = float(frequencies_hz(Candidate(model=EXACT, theory=candidate.theory), beam, None, mode)[-1])
    sizes, logs = spectrum(beam, candidate, n_modes)
    counts: list[int | None] = []
    for error in ERRORS:

        def within(size: int, error: float = error) -> bool:
            hertz = frequencies_hz(candidate, beam, size, n_modes)
            return len(hertz) >= mode and abs(float(hertz[mode - 1]) / exact - 1.0) <= error

        failing = np.flatnonzero(~(abs(np.expm1(logs[:, mode - 1] - np.log(exact))) <= error))
        if len(failing) and sizes[failing[-1]] == sizes[-1]:
            counts.append(None)
            continue
        high = int(sizes[failing[-1]]) + 1 if len(failing) else int(sizes[0])
        while not within(high):
            high += 1
        while high > 1 and within(high - 1):
            high -= 1
        counts.append(high)
    return tuple(counts)
