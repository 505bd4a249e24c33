"""Elements and links of beams with anything on them, against matrices that are written out in full and solved densely.

Only where a beam is cut comes from the models.
"""

from collections.abc import Callable
from functools import cache, partial
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass, PointSpring
from verify.beam import Beam, PointForce
from verify.models.arrays import Array
from verify.options import Attachment
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.modes.any_beam import ANY, FORCES, PLACES, PLAIN, SECTIONS
from verify.stress.references.dense import Elements, Links, Reciprocal, Sheared

PARTS, MODES = 13, 6
THIN = tuple(n for n, (_, theory) in enumerate(ANY) if theory == "euler-bernoulli")
LOSS, RATIO, DASHPOT = 0.037, 0.021, 0.013
HERTZ = np.array([3.1, 67.0, 131.0, 293.0, 431.0])
"""More than are solved one by one."""
ALONE = 3
"""Which of them is solved by itself too."""


def beams() -> tuple[Beam, ...]:
    """Those of Euler and Bernoulli with anything on them, and a stepped one between a guide and a clamp."""
    mass = PointMass(position=0.36, mass=0.022)
    spring = PointSpring(position=0.0, stiffness=510.0)
    last = replace(ANY[7][0], section=SECTIONS, mass=(mass,), spring=(spring,), supports=("guided", "clamped"))
    return (*(ANY[n][0] for n in THIN), last)


def _nodes(beam: Beam, model: str, grading: float = 1.0) -> Array:
    """Where a model cuts a beam, metres. Raises ArithmeticError where its stretches are not graded as they are told."""
    if model == "fem":
        from verify.elements.cuts import cut, stretches

        parts, pieces = cut(beam, PARTS, grading), stretches(beam)
    else:
        from verify.models.division import divide

        parts, pieces = divide(beam, PARTS, grading), beam.pieces
    lengths, start, total = parts.lengths * parts.unit, 0, 0.0
    for piece in pieces:
        total += piece.length
        end = int(np.argmin(abs(np.cumsum(lengths) - total))) + 1
        own, start = lengths[start:end], end
        steps = grading ** (1.0 / (len(own) - 1)) if len(own) > 1 else 1.0
        if (
            abs(own.sum() / piece.length - 1.0) > 1e-12
            or abs(own[1:] / own[:-1] / steps - 1.0).max(initial=0.0) > 1e-12
        ):
            raise ArithmeticError("parts end elsewhere than the beam's stretches, or are graded otherwise")
    if len(lengths) != PARTS:
        raise ArithmeticError(f"{len(lengths)} parts in place of {PARTS}")
    return np.concatenate([[0.0], np.cumsum(lengths)])


@cache
def written(model: str, number: int, grading: float = 1.0, **changes: float) -> tuple[Any, dict[str, Any]]:
    """(a model's matrices written out of one of the beams, the settings that it is asked with)."""
    beam = replace(beams()[number], **changes)
    graded = {} if grading == 1.0 else {"grading": grading}
    if model == "fem":
        return Elements(beam, _nodes(beam, model, grading)), graded
    return Links(beam, _nodes(beam, model, grading)), graded | {"attachment": "lever"}


def modes_error(model: str) -> Callable[[float], float]:
    """Beam -> worst error of frequencies, shapes, slopes and bends of parts, equal and graded."""

    def error(number: float) -> float:
        from verify.models.catalogue import MODELS

        worst = 0.0
        for grading in (1.0, 1.7):
            own, settings = written(model, int(number), grading)
            found = MODELS[model].solve_modes(own.beam, MODES, PARTS, **settings)
            worst = largest(worst, float(abs(found.frequencies_hz / own.hertz(MODES) - 1.0).max()))
            if model == "segment":
                shapes, x = found.readings["raw"](), own.nodes
                pairs = [(shapes, own.modes[1].T)]
            else:
                x = PLACES
                pairs = [(found.shapes(x, d), own.read(own.modes[1], x, d).T) for d in range(3)]
            for seen, every in pairs:
                exact = every[own.beam.rigid_motions :][:MODES]
                sides = np.sign(np.sum(pairs[0][0] * pairs[0][1][own.beam.rigid_motions :][:MODES], axis=1))[:, None]
                worst = largest(worst, float((abs(sides * seen - exact).max(axis=1) / abs(exact).max(axis=1)).max()))
                first = pairs[0][0][:, : len(x) // 2]
                worst = largest(worst, float((first[np.arange(MODES), (abs(first) > 1e-3).argmax(axis=1)] < 0.0).any()))
        return worst

    return error


def fields_error(model: str) -> Callable[[float], float]:
    """Beam -> worst error of fields without loss, with a loss factor, a ratio, dashpots; alone and in a sweep."""

    def error(number: float) -> float:
        from verify.models.catalogue import MODELS

        worst, dashed = 0.0, model == "segment"
        cases = [({}, 0.0, 0.0), ({"loss_factor": LOSS}, 0.0, 0.0), ({}, RATIO, 0.0), *([({}, 0.0, DASHPOT)] * dashed)]
        for changes, ratio, dashpot in cases:
            own, settings = written(model, int(number), **changes)
            settings = settings | ({"load": "lever", "reading": "raw"} if dashed else {})
            settings |= ({"modal_damping": ratio} if ratio else {}) | ({"joint_dashpot": dashpot} if dashpot else {})
            more = dashpot * own.bend.T @ own.bend if dashpot else None
            sweep = MODELS[model].sweep_harmonic(own.beam, FORCES, HERTZ, PARTS, **settings)
            for i, hertz in enumerate(HERTZ):
                states = own.under(own.load(FORCES), float(hertz), ratio, more)
                seen = [sweep.field(i)]
                if i == ALONE:
                    seen.append(MODELS[model].solve_harmonic(own.beam, FORCES, float(hertz), PARTS, **settings))
                for derivative in range(3):
                    exact = own.read(states, PLACES, derivative)
                    off = [abs(one.shapes(PLACES, derivative) - exact).max() for one in seen]
                    worst = largest(worst, float(largest(off) / abs(exact).max()))
        return worst

    return error


ENDS = (("pinned", "free"), ("clamped", "pinned"), ("guided", "clamped"), ("free", "guided"), ("clamped", "free"))
"""Each kind of end on either side."""


def beside_ends_error(number: float) -> float:
    """Worst error of links under forces on their first and last ones, read beside both ends; and of their modes."""
    from verify.models.catalogue import MODELS

    beam = replace(PLAIN, supports=ENDS[int(number)], loss_factor=LOSS)
    own, link, worst = Reciprocal(beam, np.linspace(0.0, beam.length, PARTS + 1)), beam.length / PARTS, 0.0
    places = (0.4 * link, 1.3 * link, beam.length - 1.6 * link, beam.length - 0.2 * link)
    forces = [PointForce(position=at, amplitude=0.7 + i, phase_deg=40.0 * i) for i, at in enumerate(places)]
    x = np.array([0.0, 0.2, 1.4, 6.3, PARTS - 1.2, PARTS - 0.3, PARTS]) * link
    for dashpot in (0.0, DASHPOT)[: 2 - (number > 1)]:
        settings = {"joint_dashpot": dashpot} if dashpot else {}
        more = dashpot * own.bend.T @ own.bend if dashpot else None
        sweep = MODELS["segment"].sweep_harmonic(beam, forces, HERTZ, PARTS, **settings)
        for i, hertz in enumerate(HERTZ):
            states = own.under(own.load(forces), float(hertz), 0.0, more)
            seen = [sweep.field(i)]
            if i == ALONE:
                seen.append(MODELS["segment"].solve_harmonic(beam, forces, float(hertz), PARTS, **settings))
            for derivative in range(3):
                exact = own.read(states, x, derivative)
                off = [abs(one.shapes(x, derivative) - exact).max() for one in seen]
                worst = largest(worst, float(largest(off) / abs(exact).max()))
    units = MODELS["segment"].unit_responses(beam, places, HERTZ, x, PARTS)
    for i, hertz in enumerate(HERTZ):
        for j, at in enumerate(places):
            exact = own.read(own.under(own.load([PointForce(position=at)]), float(hertz)), x, 0)
            worst = largest(worst, float(abs(units[i, j] - exact).max() / abs(exact).max()))
    modes, rigid = MODELS["segment"].solve_modes(beam, MODES, PARTS), beam.rigid_motions
    for derivative in range(3):
        exact = own.read(own.modes[1][:, rigid : rigid + MODES], x, derivative).T
        found = modes.shapes(x, derivative)
        sides = np.sign(np.sum(found * exact, axis=1))[:, None]
        worst = largest(worst, float((abs(sides * found - exact).max(axis=1) / abs(exact).max(axis=1)).max()))
    return worst


def units_error(number: float) -> float:
    """Worst error of elements' deflections under unit forces at two places, without and with loss."""
    from verify.models.catalogue import MODELS

    worst, positions = 0.0, (0.13, 0.48)
    for changes in ({}, {"loss_factor": LOSS}):
        own, _ = written("fem", int(number), **changes)
        found = MODELS["fem"].unit_responses(own.beam, positions, HERTZ, PLACES, PARTS)
        for i, hertz in enumerate(HERTZ):
            for j, at in enumerate(positions):
                states = own.under(own.load([PointForce(position=at)]), float(hertz))
                exact = own.read(states, PLACES, 0)
                worst = largest(worst, float(abs(found[i, j] - exact).max() / abs(exact).max()))
    return worst


THICK = tuple(n for n, (_, theory) in enumerate(ANY) if theory == "timoshenko")


def thick_error(number: float) -> float:
    """Of elements that shear, with sections, bodies, springs and ground: frequencies, deflections of modes, fields."""
    from verify.models.catalogue import MODELS

    beam, worst, theory = ANY[THICK[int(number)]][0], 0.0, {"theory": "timoshenko"}
    own = Sheared(beam, _nodes(beam, "fem"))
    found, rigid = MODELS["fem"].solve_modes(beam, MODES, PARTS, **theory), beam.rigid_motions
    worst = float(abs(found.frequencies_hz / own.hertz(MODES) - 1.0).max())
    shapes, exact = found.shapes(PLACES, 0), own.read(own.modes[1][:, rigid : rigid + MODES], PLACES).T
    sides = np.sign(np.sum(shapes * exact, axis=1))[:, None]
    worst = largest(worst, float((abs(sides * shapes - exact).max(axis=1) / abs(exact).max(axis=1)).max()))
    for loss, ratio in ((0.0, 0.0), (LOSS, 0.0), (0.0, RATIO)):
        lossy = replace(beam, loss_factor=loss)
        own.beam = lossy
        settings = theory | ({"modal_damping": ratio} if ratio else {})
        sweep = MODELS["fem"].sweep_harmonic(lossy, FORCES, HERTZ, PARTS, **settings)
        units = None if ratio else MODELS["fem"].unit_responses(lossy, (0.48,), HERTZ, PLACES, PARTS, **theory)
        for i, hertz in enumerate(HERTZ):
            exact = own.read(own.under(own.load(FORCES), float(hertz), ratio), PLACES)
            seen = [sweep.field(i)]
            if i == ALONE:
                seen.append(MODELS["fem"].solve_harmonic(lossy, FORCES, float(hertz), PARTS, **settings))
            off = [abs(one.shapes(PLACES, 0) - exact).max() for one in seen]
            worst = largest(worst, float(largest(off) / abs(exact).max()))
            if units is not None:
                exact = own.read(own.under(own.load([PointForce(position=0.48)]), float(hertz)), PLACES)
                worst = largest(worst, float(abs(units[i, 0] - exact).max() / abs(exact).max()))
    return worst


def buckling_error(model: str) -> Callable[[float], float]:
    """Beam -> error of its buckling load, whatever pulls at it."""

    def error(number: float) -> float:
        from verify.models.catalogue import MODELS

        own, settings = written(model, int(number), tension=0.0)
        load = float(own.buckling(own.turned))
        pulled = replace(own.beam, tension=0.3 * load)
        return largest(
            abs(MODELS[model].buckling_load(beam, PARTS, **settings) / load - 1.0) for beam in (own.beam, pulled)
        )

    return error


def stacked_error(model: str) -> Callable[[float], float]:
    """Beam -> worst difference between nine beams like it solved together and each by itself, and how many are not."""

    def error(number: float) -> float:
        from importlib import import_module

        from verify.models.catalogue import MODELS
        from verify.models.stacks import lowest_of_each

        several = [_like(beams()[int(number)], 1.0 + 0.07 * i) for i in range(9)]
        room, settings = "elements" if model == "fem" else "segments", {} if number else {"attachment": "lever"}
        together = import_module(f"verify.{room}.sweeps").sweep_modes(several, 2, 20, **settings)
        alone = [MODELS[model].solve_modes(beam, 2, 20, **settings).frequencies_hz for beam in several]
        stack = _stacked(model, several, 20, "reciprocal" if number else "lever")
        left = sum(not sure for sure in lowest_of_each(stack, 2)[1])
        return largest(float(abs(together / np.array(alone) - 1.0).max()), float(left))

    return error


def _stacked(model: str, several: list[Beam], count: int, attachment: Attachment) -> Any:
    """A stack of beams. Raises ArithmeticError where they are not of one layout."""
    if model == "fem":
        from verify.elements.stacks import element_stack, layout

        shared = {layout(beam, count, 1.0, "euler-bernoulli") for beam in several}
        found = element_stack(several, count, 1.0, "euler-bernoulli")
    else:
        from verify.segments import stacks
        from verify.segments.linear import settings_of

        settings = settings_of("gregory", "series", 1.0, "euler-bernoulli", attachment)
        shared = {stacks.layout(beam, **settings) for beam in several}
        found = stacks.chain_stack(several, count, settings)
    if len(shared) != 1 or None in shared:
        raise ArithmeticError("beams that are alike are not taken together")
    return found


def _like(beam: Beam, part: float) -> Beam:
    """The same with what stands on it, pulls at it and carries it so many times as much."""
    mass = tuple(replace(one, mass=one.mass * part, rotary_inertia=one.rotary_inertia * part**2) for one in beam.mass)
    spring = tuple(
        replace(one, stiffness=one.stiffness / part, rotational=one.rotational * part) for one in beam.spring
    )
    section = beam.section and (replace(beam.section[0], bending_stiffness=3.1 * part), *beam.section[1:])
    own = {} if section else {"bending_stiffness": (beam.bending_stiffness or 1.0) * part, "length": beam.length}
    return replace(beam, mass=mass, spring=spring, section=section, foundation=beam.foundation * part, **own)


NUMBERS = tuple(float(n) for n in range(len(THIN) + 1))
_row = partial(Floor, along="beam")

ROWS: tuple[Row, ...] = (
    _row(
        id="modes-of-elements-written-out",
        title="Six modes of 13 elements, equal and graded, against textbook matrices solved densely",
        why="elements/linear.py: the same elements; LAPACK on assembled matrices keeps nine digits.",
        promise=1e-9,
        at=NUMBERS,
        error=modes_error("fem"),
    ),
    _row(
        id="modes-of-links-written-out",
        title="Six modes of 13 links, equal and graded, with bodies where they stand, against matrices solved densely",
        why="segments/links.py: the same links and springs, to the rounding of dense matrices.",
        promise=1e-9,
        at=NUMBERS,
        error=modes_error("segment"),
    ),
    _row(
        id="fields-of-elements-written-out",
        title="Fields of 13 elements without loss, with a loss factor and with a ratio, alone and in a sweep",
        why="elements/linear.py, elements/sweeps.py: the same matrices, solved densely.",
        promise=1e-8,
        at=(0, 1, 3, 5),
        error=fields_error("fem"),
    ),
    _row(
        id="fields-of-links-written-out",
        title="Fields of 13 links without loss, with a loss factor, a ratio and dashpots, alone and in a sweep",
        why="segments/linear.py, segments/sweeps.py: the same matrices, solved densely.",
        promise=1e-9,
        at=(0, 1, 3, 5),
        error=fields_error("segment"),
    ),
    Floor(
        id="links-beside-their-ends",
        title="Links under forces on their first and last ones, read there: fields, unit forces and shapes",
        why="segments/loads.py, segments/reading.py: the same rules, mirrored at pinned and guided ends.",
        along="pair of ends",
        at=(0, 1, 2, 3, 4),
        promise=1e-9,
        error=beside_ends_error,
    ),
    Floor(
        id="elements-that-shear-written-out",
        title="Elements by Timoshenko's theory with sections, bodies, springs and ground: modes, fields, unit forces",
        why="elements/shear.py: a cubic line and a linear shear strain in each, tied at nodes and solved densely.",
        along="beam",
        at=(0, 2),
        promise=1e-8,
        error=thick_error,
    ),
    _row(
        id="unit-forces-of-elements",
        title="Deflections of 13 elements under unit forces, without and with loss",
        why="elements/linear.py: sums over all modes, against the same matrices solved densely.",
        promise=1e-9,
        at=(0, 1, 3, 5),
        error=units_error,
    ),
    Floor(
        id="buckling-of-elements-written-out",
        title="Buckling loads of 13 elements on springs and ground, pulled at or not",
        why="elements/pencil.py: the same matrices, solved densely.",
        along="beam",
        at=NUMBERS[:4] + NUMBERS[5:],
        promise=1e-9,
        error=buckling_error("fem"),
    ),
    Floor(
        id="buckling-of-links-written-out",
        title="The same of 13 links",
        why="segments/buckling.py: the same matrices, solved densely.",
        along="beam",
        at=NUMBERS[:4] + NUMBERS[5:],
        promise=1e-9,
        error=buckling_error("segment"),
    ),
    Floor(
        id="nine-beams-at-once-elements",
        title="Nine beams of elements in one call against each by itself, and how many of them do not settle together",
        why="models/stacks.py: each as right as if it had been asked for alone.",
        along="beam",
        at=(4, 5),
        promise=1e-11,
        error=stacked_error("fem"),
    ),
    Floor(
        id="nine-beams-at-once-segments",
        title="The same of segments",
        why="models/stacks.py: each as right as if it had been asked for alone.",
        along="beam",
        at=(0, 5),
        promise=1e-11,
        error=stacked_error("segment"),
    ),
)
