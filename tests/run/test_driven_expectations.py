"""What gates of driven fields, of shapes, of motion and of loads at rest expect is known without the suite."""

import driven_reference
import pytest
import released_reference

from verify.scenes.scene import load_scene

SCENES = (
    "driven-cantilever",
    "guided-bar",
    "free-free-bar",
    "stepped-beam",
    "taut-strip",
    "instrument-arm",
    "thick-bar",
)
ELSEWHERE = (
    "fastest-crests",
    "fastest-crests-imposed",
    "imposed-reflection-per-hertz",
    "imposed-reflection-per-degree",
)
"""Gates of `paper-wave`."""
KNOWN = [
    (scene, gate.id)
    for scene in (*SCENES, "paper-wave", "paper-slider")
    for gate in load_scene(scene).gate
    if gate.id in ELSEWHERE
    or (scene in SCENES and gate.quantity in (*driven_reference.FIGURES, *released_reference.KNOWN))
]


@pytest.mark.parametrize(("scene", "gate"), KNOWN)
def test_a_figure_comes_out_of_states_elements_and_links_written_out(scene, gate):
    """To three fifths of its band: the rest is what rounding, or modes left out, leave of the model itself."""
    loaded = load_scene(scene)
    found = next(one for one in loaded.gate if one.id == gate)
    expected = found.expect if isinstance(found.expect, float | int) else complex(found.expect.re, found.expect.im)
    if found.quantity in driven_reference.FIGURES:
        figure = driven_reference.known(loaded, found)
    else:
        figure = released_reference.KNOWN[found.quantity](loaded, found.arguments)
    assert abs(figure - expected) <= 0.6 * found.within
