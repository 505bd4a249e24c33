"""What methods are compared in: for each set who asks for it, which cases it has, and what a process pays for it."""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import msgspec

from verify.bench.request import Bench, Settled
from verify.errors import InputError
from verify.options import BenchSet

if TYPE_CHECKING:
    from verify.bench.kind import Case
    from verify.judge.workbench import Workbench
    from verify.quantities.kind import Work
    from verify.scenes.scene import Scene

COUNTS, MODES, LINKS = (24, 49, 98, 196), (1, 5, 22), (49,)
PERIODS = 4.0
"""Of the drive, that a motion lasts where the scene does not say how long."""


class MethodSet(msgspec.Struct, frozen=True, kw_only=True):
    """Methods that all do the same."""

    name: BenchSet
    unasked: Callable[["Scene"], str]
    """Why it is left out where nobody names it; empty where the scene has what it takes."""
    cases: Callable[["Scene", Settled, "Workbench"], "Iterator[Case]"]
    """Raises InputError where the scene has not what it takes."""
    works: tuple["Work", ...]
    """Kinds of what its methods do."""
    elements: bool = True
    """Whether finite elements take part, and scikit-fem is imported."""
    compiled: bool = False
    """Whether its loops are."""


def _always(scene: "Scene") -> str:
    return ""


def _undriven(scene: "Scene") -> str:
    driven = scene.drive is not None and any(force.amplitude for force in scene.drive.force)
    return "" if driven else "nothing drives the beam"


def _still(scene: "Scene") -> str:
    if scene.slider is not None and scene.motion is not None:
        return ""
    return f"the scene has no [{'slider' if scene.slider is None else 'motion'}]"


def _unchained(scene: "Scene") -> str:
    if not _chained(scene):
        return "nothing in the scene asks for the nonlinear chain: name it in sets"
    return _undriven(scene)


def _chained(scene: "Scene") -> bool:
    """Whether a study or a gate of a scene asks for the nonlinear chain."""
    from verify.motor.combine import CHAIN
    from verify.quantities.catalogue import QUANTITIES

    axial, motor = (getattr(scene, name, None) for name in ("axial_inertia", "motor"))
    known = (QUANTITIES[gate.quantity] for gate in scene.gate if gate.quantity in QUANTITIES)
    studied = axial is not None or (motor is not None and CHAIN in motor.models)
    return studied or any(quantity.arguments.chained for quantity in known)


def _mode_cases(scene: "Scene", its: Settled, bench: "Workbench") -> "Iterator[Case]":
    from verify.bench.mode_set import mode_cases

    return mode_cases(scene, its, bench)


def _field_cases(scene: "Scene", its: Settled, bench: "Workbench") -> "Iterator[Case]":
    from verify.bench.field_set import field_cases

    return field_cases(scene, its)


def _transient_cases(scene: "Scene", its: Settled, bench: "Workbench") -> "Iterator[Case]":
    from verify.bench.transient_set import transient_cases

    return transient_cases(scene, its)


def _slider_cases(scene: "Scene", its: Settled, bench: "Workbench") -> "Iterator[Case]":
    from verify.bench.slider_set import slider_cases

    return slider_cases(scene, its)


def _chain_cases(scene: "Scene", its: Settled, bench: "Workbench") -> "Iterator[Case]":
    from verify.bench.chain_set import chain_cases

    return chain_cases(scene, its)


SETS: dict[str, MethodSet] = {
    one.name: one
    for one in (
        MethodSet(name="modes", unasked=_always, cases=_mode_cases, works=("modes",)),
        MethodSet(name="harmonic", unasked=_undriven, cases=_field_cases, works=("harmonic",)),
        MethodSet(name="transient", unasked=_undriven, cases=_transient_cases, works=("in time",)),
        MethodSet(name="slider", unasked=_still, cases=_slider_cases, works=("harmonic", "in time"), compiled=True),
        MethodSet(
            name="chain", unasked=_unchained, cases=_chain_cases, works=("in time",), elements=False, compiled=True
        ),
    )
}
"""In the order in which they are run."""


def settled(asked: Bench, scene: "Scene") -> Settled:
    """What a scene's [bench] comes to. Raises InputError for a drive with devices."""
    scene.refuse_devices("a bench")
    convergence, axial = getattr(scene, "convergence", None), getattr(scene, "axial_inertia", None)
    duration = scene.motion.duration if scene.motion else getattr(axial, "duration", None)
    if duration is None and scene.drive:
        duration = PERIODS / scene.drive.frequency_hz
    own = convergence.counts if convergence else scene.motion.counts if scene.motion else COUNTS
    asking = next((one for one in (axial, scene.motion, getattr(scene, "motor", None)) if one), None)
    chain = (asking.count,) if asking else LINKS
    return Settled(
        sets=asked.sets or tuple(one.name for one in SETS.values() if not one.unasked(scene)),
        counts=tuple(sorted(asked.counts or (n for n in own if n > 1))),
        chains=tuple(sorted(asked.counts or chain)),
        modes=asked.modes or (convergence.modes if convergence else MODES),
        duration=asked.duration or duration or 0.0,
        x=asked.x if asked.x is not None else 0.5 * scene.beam.length,
        peers=asked.peers,
    )


def all_cases(asked: Bench, scene: "Scene", bench: "Workbench") -> "tuple[list[Case], list[str], list[str]]":
    """(every case, why sets are not asked for and methods left out, why sets that are asked for cannot be run)."""
    its = settled(asked, scene)
    left = (one for one in SETS.values() if one.name not in its.sets)
    notes = [f"{one.name} is left out: {one.unasked(scene) or 'it is not among sets'}" for one in left]
    cases: list[Case] = []
    refused: list[str] = []
    for name in its.sets:
        try:
            cases += SETS[name].cases(scene, its, bench)
        except InputError as error:
            refused.append(f"{name} is left out: {error}")
    notes += dict.fromkeys(note for case in cases for note in case.notes)
    return cases, notes, refused
