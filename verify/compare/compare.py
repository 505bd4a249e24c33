"""Comparison of frequencies from another program with candidate discretisations and the exact beam of a scene."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import product
from typing import Any, get_args

import msgspec
import numpy as np

from verify.analysis.comparison import LEAST_MAC, LOW_MAC, mac, node_weights, pair_modes
from verify.analysis.verdict import Margin
from verify.arrays import Array, Indices
from verify.compare.candidates import CHAIN, ELEMENTS, EULER, EXACT, Candidate, candidates, frequencies_hz
from verify.compare.fit import Data, Identification, identify, spectrum
from verify.compare.reading import MOST, FrequencyList, ModeShapes
from verify.compare.report import Entry, result_of
from verify.compare.sorting import ACROSS, BENDING, Sorted, rigid_of, sort_list
from verify.errors import InputError
from verify.linear.registry import MODELS
from verify.problem.beam import Beam
from verify.problem.supports import Support
from verify.report.result import Result
from verify.scene.file import NamedBeam
from verify.settings import THEORIES
from verify.validation import check_integer

SPARE = 4
"""Number of modes above those of a list for the pairing of shapes."""
ERRORS = (1e-2, 1e-3)
"""Errors for which the required N is computed; the first is the default of the accuracy."""
FOLLOWED = 0.25
"""Largest error against Timoshenko over that against Euler-Bernoulli of a list that follows the former."""
SIMILAR = 0.02
"""Difference of the lower modes from those of other supports that are named."""


class Options(msgspec.Struct, frozen=True, kw_only=True):
    """Options of a comparison; None: any, for `mode` the last of the list.

    `count`: N of the model. `kind`: 'segments' or 'elements'. `mode`: mode for the required N. `within`: accuracy,
    the largest relative error against the exact beam. `theory`: theory of the exact beam; None: Euler-Bernoulli, or
    the one that the list follows.
    """

    count: int | None = None
    kind: str | None = None
    mode: int | None = None
    within: float = ERRORS[0]
    theory: str | None = None


def compare(
    scene: NamedBeam,
    listed: FrequencyList,
    shapes: ModeShapes | None = None,
    options: Options | None = None,
    progress: Callable[[str], None] = lambda step: None,
) -> Result:
    """Identify the discretisation behind frequencies of the scene's beam and their errors. Raises InputError.

    `shapes`, one per frequency, identify the modes. `data["passed"]` of the result is the acceptance.
    """
    beam, options, read = scene.beam, options or Options(), listed
    for field in ("count", "mode"):
        if getattr(options, field) is not None:
            check_integer(field, getattr(options, field), 1, MOST)

    def sorted_by(theory: str) -> Sorted:
        return _by_shape(beam, read, shapes, theory) if shapes else sort_list(beam, read, theory)

    elastic = sorted_by(options.theory or EULER)
    listed, rigid, macs, hertz = elastic.listed, elastic.rigid, elastic.macs, elastic.listed.hertz
    bending = np.array(elastic.motions) == BENDING
    entries, modes = elastic.entries[bending], elastic.modes[bending]
    ordered = macs is None and bool(bending.all()) and bool((modes == entries - rigid).all())
    logs, members, rounding = np.log(np.maximum(hertz, 1e-300)), candidates(beam, options.kind), listed.rounding
    given = {"entries": entries, "modes": modes, "ordered": ordered, "count": options.count}
    data = Data(beam=beam, logs=logs, rounding=rounding, members=members, **given)
    fits = identify(data, progress)
    euler, chosen = elastic, options.theory or _followed(beam, fits, elastic, sorted_by, options.within)
    if chosen != (options.theory or EULER):
        elastic = sorted_by(chosen)
    options = msgspec.structs.replace(options, theory=chosen)
    columns = [(elastic.entries + 1).tolist(), (elastic.modes + 1).tolist(), hertz[elastic.entries].tolist()]
    columns += [elastic.exact.tolist(), [None] * len(bending) if macs is None else macs.tolist(), elastic.motions]
    rows = [Entry(*cells) for cells in zip(*columns, strict=True)]
    disorder = (np.diff(entries[np.argsort(modes, kind="stable")]) < 0).any()
    unlike = 0 if macs is None else len(hertz) - rigid - int((macs >= LOW_MAC).sum())
    supports = _other_supports(beam, logs[entries], modes) if fits.status == "unknown" else ()
    motions = beam.rigid_motions  # in space and along the axis there are more
    gaps = ", ".join(map(str, elastic.gaps)) if fits.best.fault.kind not in ("missing", "extra") else ""
    messages = {
        f"The list leaves out bending modes of the beam: {gaps}.": gaps,
        f"The list starts with {rigid} rigid-body motions, the beam of the scene has {motions}.": rigid
        and rigid not in ((motions, motions + 1, 2 * motions, 2 * motions + 1, 2 * motions + 2) if motions else (0,)),
        f"The values are in {listed.unit}, not in {read.unit}.": listed.unit != read.unit and read.declared,
        "Frequencies are not in the order of the modes: see the column entry.": disorder,
        f"{unlike} of the shapes have a MAC below {LOW_MAC} with all modes of the beam: check beam.supports.": unlike,
        f"The lower modes are those of a beam with other supports: {'-'.join(supports)}.": supports,
    }
    warnings = [text for text, holds in messages.items() if holds]
    result = result_of(scene.name, listed, data, fits, rows, _required(data, fits, options), warnings, options)
    aside = [
        Margin(
            name=f"{one}, that is set aside", size=0.0, fine=-1.0, limit=np.inf, condition=f"{one}, is no bending mode"
        )
        for one in elastic.unknown
    ]
    notes = _notes(elastic, euler, chosen)
    return replace(result, summary=result.summary + notes, margins=[*result.margins, *aside])


def _notes(elastic: Sorted, euler: Sorted, theory: str) -> str:
    """Sentences on the theory that the list follows, and on entries that are set aside."""
    notes = ""
    if elastic is not euler:
        off = f"up to {100.0 * abs(_errors(euler)).max():.2g} % off by Euler-Bernoulli"
        notes = f" The list follows the exact beam by {theory.capitalize()}, its errors are against that; {off}."
    return f"{notes} Set aside, of no known motion: {'; '.join(elastic.unknown)}." if elastic.aside else notes


def _errors(elastic: Sorted) -> Array:
    """Relative errors of the bending entries, (k,)."""
    bent = np.array([motion in (BENDING, ACROSS) for motion in elastic.motions])
    return np.asarray(elastic.listed.hertz[elastic.entries][bent] / elastic.exact[bent] - 1.0)


def _followed(
    beam: Beam, fits: Identification, euler: Sorted, sorted_by: Callable[[str], Sorted], within: float
) -> str:
    """Timoshenko where the list is of a stocky beam and follows that theory, else Euler-Bernoulli."""
    largest, other = abs(_errors(euler)).max(initial=0.0), THEORIES[-1]
    claims = fits.status in ("identified", "ambiguous") and fits.best.candidate.theory == EULER
    known = all(piece.shear_stiffness and piece.rotary_inertia for piece in beam.pieces)
    if claims or largest <= within or beam.tension or not known:
        return EULER
    return other if abs(_errors(sorted_by(other))).max() < FOLLOWED * largest else EULER


def _by_shape(beam: Beam, listed: FrequencyList, shapes: ModeShapes, theory: str) -> Sorted:
    """The entries that are modes by their shapes. Raises InputError."""
    if len(shapes.values) != len(listed.values):
        raise InputError(f"modes = {len(shapes.values)} shapes for {len(listed.values)} frequencies: give one for each")
    rigid = rigid_of(beam, listed.hertz)
    if not listed.hertz[rigid:].all():
        raise InputError(f"{listed.source} has zeros but no elastic mode: give elastic frequencies")
    modes, macs = pair_shapes(beam, shapes.x, shapes.values[rigid:])
    like = macs >= LEAST_MAC
    modes, entries = modes[like], rigid + np.flatnonzero(like)
    exact = frequencies_hz(Candidate(model=EXACT, theory=theory), beam, None, int(modes.max()) + 1)[modes]
    return Sorted(listed, rigid, entries, (BENDING,) * len(modes), modes, exact, macs[like])


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
    try:
        return np.asarray(MODELS[EXACT].build(beam).modes(n_modes).deflection(x))
    except InputError:
        fine = max(10 * n_modes, 8 * len(beam.pieces))
        return np.asarray(MODELS[ELEMENTS].build(beam, fine).modes(n_modes).deflection(x))


def _other_supports(beam: Beam, logs: Array, modes: Indices) -> Sequence[str]:
    """Other supports with which the exact beam has the lower half of the frequencies; empty if none."""
    low = modes < max(len(logs) // 2, 2)
    for supports in (beam.supports, *product(get_args(Support), repeat=2)):
        other = msgspec.structs.replace(beam, supports=supports)
        try:
            exact = np.log(frequencies_hz(Candidate(model=EXACT), other, None, int(modes[low].max(initial=0)) + 1))
        except InputError:  # for example a beam that has buckled
            continue
        if low.sum() > 1 and abs(logs[low] - exact[modes[low]]).max() < SIMILAR:
            return () if supports == beam.supports else supports
    return ()


def _required(data: Data, fits: Identification, options: Options) -> list[tuple[Any, ...]]:
    """(candidate, mode, N for each of ERRORS or None beyond LARGEST) of the best and the usual candidates."""
    beam, theory, mode = data.beam, options.theory or EULER, options.mode or int(data.modes.max()) + 1
    rules = ("gregory", "half", "full") if "clamped" in beam.supports else (None,)
    joints = "tensioned" if beam.tension else "series"
    sized = [
        *([fits.best.candidate] if fits.status != "unknown" and fits.best.candidate.sized else []),
        *(Candidate(model=CHAIN, mass="links", wall=rule, joints=joints, theory=theory) for rule in rules),
        Candidate(model=ELEMENTS, mass="consistent", theory=theory),
    ]
    n_modes = max(mode, data.n_modes)

    def error(candidate: Candidate, size: int) -> float:
        try:
            hertz = frequencies_hz(candidate, beam, size, n_modes)
        except InputError:  # fewer parts than pieces
            return np.inf
        exact = frequencies_hz(Candidate(model=EXACT, theory=candidate.theory), beam, None, mode)[-1]
        return abs(float(hertz[mode - 1]) / float(exact) - 1.0) if len(hertz) >= mode else np.inf

    rows: list[tuple[Any, ...]] = []
    for candidate in dict.fromkeys(sized):
        exact = frequencies_hz(Candidate(model=EXACT, theory=candidate.theory), beam, None, mode)[-1]
        sizes, logs = spectrum(beam, candidate, n_modes)
        counts: list[int | None] = []
        for limit in ERRORS:  # from the interpolated N to the one that is solved
            failing = sizes[~(abs(np.expm1(logs[:, mode - 1] - np.log(exact))) <= limit)]
            count = int(failing[-1]) + 1 if len(failing) else int(sizes[0])
            if count <= sizes[-1]:
                while error(candidate, count) > limit:
                    count += 1
                while count > 1 and error(candidate, count - 1) <= limit:
                    count -= 1
            counts.append(count if count <= sizes[-1] else None)
        rows.append((candidate, mode, *counts))
    return rows
