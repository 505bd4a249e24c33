"""How fast and how far a scene's beam moves, in hertz and metres: what percentages do not show."""

from typing import TYPE_CHECKING

from verify.errors import InputError
from verify.units import in_words
from verify.words import number

if TYPE_CHECKING:
    from verify.judge.workbench import Workbench
    from verify.scenes.scene import Scene

PLACES = 201


def scale_in_words(scene: "Scene") -> str:
    """The first frequency of the exact beam, and its largest deflection where it is driven; empty where it has none."""
    from verify.judge.workbench import Workbench

    bench = Workbench(scene.beam)
    try:
        first = f"The beam's first mode is at {number(bench.exact_hz(1), 5)} Hz"
    except InputError:
        return ""
    return f"{first}{_driven(scene, bench)}."


def _driven(scene: "Scene", bench: "Workbench") -> str:
    """The largest deflection of the steady field, undamped where the beam is."""
    import numpy as np

    from verify.quantities.cases import driven_case
    from verify.quantities.wave_arguments import Driven
    from verify.waves.driven import driven

    if scene.drive is None or not scene.forces:
        return ""
    try:
        field = driven(driven_case(Driven(), scene), bench)
        largest = abs(field.deflection(np.linspace(0.0, scene.beam.length, PLACES))).max()
    except InputError:  # at a resonance without losses there is none
        return ""
    if not largest:
        return ""
    imposed = "" if scene.drive.kind == "force" else " imposed"
    told = f"driven{imposed} at {number(scene.drive.frequency_hz, 5)} Hz, it deflects by up to"
    return f"; {told} {in_words(float(largest))} in the steady state"
