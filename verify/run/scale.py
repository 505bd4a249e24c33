"""How fast and how far a scene's beam moves, in hertz and metres: what percentages do not show."""

from collections.abc import Iterator
from contextlib import suppress
from typing import TYPE_CHECKING, Any, get_args

from verify.errors import InputError
from verify.options import Theory
from verify.units import in_words
from verify.words import number, theory_name

if TYPE_CHECKING:
    from verify.judge.workbench import Workbench
    from verify.scenes.scene import Scene

EULER: Theory = "euler-bernoulli"
PLACES = 201
SMALL = 0.1
"""Of the beam's length: what bends farther is not told without a word."""
NO_THEORY = ("name", "title", "description", "beam", "drive", "slider", "gate", "claim")
"""Of a scene: what is no study. Gates are looked at one by one."""


def scale_in_words(scene: "Scene") -> str:
    """The first frequency of the exact beam, and its largest deflection where it is driven; empty where it has none.

    By every theory that the scene asks for, which are named unless that is Euler-Bernoulli's alone.
    """
    from verify.judge.workbench import Workbench

    bench, found = Workbench(scene.beam), dict[Theory, float]()
    for theory in theories_of(scene):
        with suppress(InputError):
            found[theory] = bench.exact_hz(1, theory)
    if not found:
        return ""
    named = [f"{number(hertz, 5)} Hz{_by(theory, tuple(found))}" for theory, hertz in found.items()]
    return f"The beam's first mode is at {' and '.join(named)}{_driven(scene, bench, tuple(found))}."


def theories_of(scene: "Scene") -> tuple[Theory, ...]:
    """Those by which anything in a scene is asked for, in their own order; Euler-Bernoulli's where nothing is."""
    import msgspec

    asked = [dict(gate.arguments).get("theory", EULER) for gate in scene.gate]
    for name, section in msgspec.to_builtins(scene).items():
        if section is not None and name not in NO_THEORY:
            asked += [*_stated(section)] or ([EULER] if section else [])
    return tuple(theory for theory in get_args(Theory) if theory in asked) or (EULER,)


def _stated(value: Any) -> Iterator[str]:
    """Every theory that is named anywhere in plain data."""
    parts = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for name, part in parts:
        if name == "theory":
            yield part
        else:
            yield from _stated(part)


def _by(theory: str, found: tuple[str, ...]) -> str:
    return "" if found == (EULER,) else f" by {theory_name(theory)} theory"


def _driven(scene: "Scene", bench: "Workbench", theories: tuple[Theory, ...]) -> str:
    """The largest deflection of the steady field, undamped where the beam is, by each theory that has one."""
    if scene.drive is None or not scene.forces:
        return ""
    found = {theory: size for theory in theories if (size := _largest(scene, bench, theory))}
    if not found:
        return ""
    imposed = "" if scene.drive.kind == "force" else " imposed"
    told = f"driven{imposed} at {number(scene.drive.frequency_hz, 5)} Hz, it deflects by up to"
    sizes = " and ".join(
        in_words(size) + (_by(theory, theories) if len(theories) > 1 else "") for theory, size in found.items()
    )
    return f"; {told} {sizes} in the steady state{_beyond(max(found.values()) / scene.beam.length)}"


def _largest(scene: "Scene", bench: "Workbench", theory: Theory) -> float:
    """Metres; 0 at a resonance without losses, where there is no such field, and by a theory that has none."""
    import numpy as np

    from verify.quantities.cases import driven_case
    from verify.quantities.wave_arguments import Driven
    from verify.waves.driven import driven

    try:
        field = driven(driven_case(Driven(theory=theory), scene), bench)
        return float(abs(field.deflection(np.linspace(0.0, scene.beam.length, PLACES))).max())
    except InputError:
        return 0.0


def _beyond(share: float) -> str:
    """What is said of a deflection so many times the beam's length."""
    if share <= SMALL:
        return ""
    told = f"{number(100.0 * share, 3)} % of" if share < 1.0 else f"{number(share, 3)} times"
    return f", {told} its length: linear theory, and every figure by it, is of far smaller ones"
