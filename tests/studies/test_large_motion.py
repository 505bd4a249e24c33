"""A beam of one's own on a moving base: [base] of a scene, study large-motion, quantities blade.*."""

import json
import tomllib
from math import pi, sqrt

import numpy as np
import pytest

from verify import InputError, run_scene
from verify.analysis.solution_cache import SolutionCache
from verify.cli import status_of
from verify.quantities.base import evaluate
from verify.scene.load import scene_from
from verify.studies.base import result_of

BLADE = """
name = "blade"
[beam]
length = 1.3
bending_stiffness = 0.7
mass_per_length = 2.1
supports = ["clamped", "free"]
[base]
duration = 3.0
"""
L, EI, RHO_A = 1.3, 0.7, 2.1
UNIT = sqrt(EI / RHO_A) / L**2  # of angular frequencies, rad/s
BOTH = pytest.mark.parametrize("model", ["segment", "fem"])


def scene(*lines, beam=""):
    return scene_from(tomllib.loads(BLADE.replace("[base]", f"{beam}\n[base]") + "\n".join(lines)))


def measured(scene, name, **arguments):
    return evaluate(f"blade.{name}", arguments, scene, SolutionCache(scene.beam))


@pytest.mark.parametrize(
    ("duration", "tip"),  # of EI/(m g L^3) = 0.01 after 1 and 2 sqrt(L/g), printed in five digits
    [(1.0, (0.766509, -0.519676)), (2.0, (-0.746184, -0.653092))],
)
@pytest.mark.parametrize(("model", "within"), [("segment", 1.5e-3), ("fem", 2e-4)])
def test_a_beam_that_is_released_on_a_pin_falls_as_the_flexible_pendulum_does(duration, tip, model, within):
    g = 3.7
    beam = {"length": 2.2, "bending_stiffness": 0.01 * 0.8 * g * 2.2**3, "mass_per_length": 0.8}
    base = {"duration": duration * sqrt(2.2 / g), "gravity": [0.0, -g]}
    falls = scene_from({"name": "f", "beam": beam | {"supports": ["pinned", "free"]}, "base": base})
    end = [measured(falls, name, model=model, count=32 if model == "segment" else 16) for name in ("tip_x", "tip_y")]
    assert np.array(end) / 2.2 == pytest.approx(tip, abs=within)


@BOTH
def test_a_slow_turn_bends_it_as_its_inertia_bends_a_cantilever_at_rest(model):
    turn, hub, rise = 2e-3, 0.4, 40.0  # angular acceleration turn (2 s^3 - s^4), s = t/rise: 8 periods of mode 1
    s = np.linspace(0.0, 1.0, 41)
    values = turn * rise**2 * (s**5 / 10.0 - s**6 / 30.0)
    base = {"duration": rise, "hub_radius": hub, "rotation": {"times": (rise * s).tolist(), "values": values.tolist()}}
    bent = scene_from(tomllib.loads(BLADE) | {"base": base})
    lag = RHO_A * turn * (hub * L**4 / 8.0 + 11.0 * L**5 / 120.0) / EI
    moment = RHO_A * turn * (hub * L**2 / 2.0 + L**3 / 3.0)
    assert -measured(bent, "tip_y", model=model) == pytest.approx(lag, rel=0.01)
    assert measured(bent, "root_moment", model=model) == pytest.approx(moment, rel=0.02)


def test_joints_that_follow_the_axial_force_bring_links_nearer_to_elements():
    off = []
    for joints in ("series", "tensioned"):
        spun = scene("rotation = [0.0, 2.0]", "gravity = [0.0, -0.4]", "[large-motion]", f'joints = "{joints}"')
        off.append(run_scene(spun).results["large-motion"].tables[0].records()[0]["path off"])
    assert off[1] < 0.3 * off[0]
    assert off[0] > 1e-3


@pytest.mark.parametrize(("model", "within"), [("segment", 1e-7), ("fem", 1e-6)])
def test_in_steady_rotation_it_stays_straight(model, within):
    turns = scene("rotation = [0.3, 1.7]", "hub_radius = 0.2")
    figures = [measured(turns, name, model=model) for name in ("lag", "lead", "tip_x", "tip_y")]
    assert figures == pytest.approx([0.0, 0.0, L, 0.0], abs=within)


@pytest.mark.parametrize(("model", "count"), [("segment", 80), ("fem", 24)])
def test_rotation_and_hub_radius_raise_its_frequencies_as_by_the_slopes_of_the_series(model, count):
    def square(name, mode, rate, hub=0.0):
        found = measured(scene(f"hub_radius = {hub}"), name, mode=mode, rate=rate, model=model, count=count)
        return (2.0 * pi * found) ** 2

    rate, hub = 0.1 * UNIT, 0.35
    still, turned = square("flap", 1, 0.0), square("flap", 1, rate)
    slopes = [turned - still, square("flap", 2, rate) - square("flap", 2, 0.0)]
    slopes += [square("flap", 1, rate, hub * L) - turned, square("lead_lag", 1, rate) - turned]
    assert np.array(slopes) / rate**2 == pytest.approx(
        [1.1933363741083, 6.4782248640761, hub * 1.5708781899943, -1.0], rel=2e-3
    )


def test_the_study_states_the_difference_of_links_and_elements_and_the_axial_stiffness_that_it_assumes():
    turned = scene("rotation = [0.0, 0.0, 0.1]", "gravity = [0.0, -0.8]", "hub_radius = 0.1")
    result = result_of("large-motion", turned, SolutionCache(turned.beam))
    rows = result.tables[0].records()
    assert [row["N"] for row in rows] == [20, 40, 8, 16]
    assert result.verdict.level == "trusted"
    assert rows[1]["path off"] == max(margin.size for margin in result.margins if "links" in margin.name)
    assert rows[1]["largest lag"] == pytest.approx(rows[3]["largest lag"], rel=3e-3)
    assert rows[1]["largest lag"] > 0.3 * L
    assert rows[1]["root moment"] == pytest.approx(rows[3]["root moment"], rel=0.02)
    assert result.data["axial_stiffness"] == pytest.approx(1e8 * EI / L**2)
    assert any("EA is unknown" in note for note in result.tables[0].notes)


@pytest.mark.parametrize("lines", [(), ("x = [0.0, 1.7]",)])
def test_on_a_base_that_rests_or_glides_evenly_nothing_moves(lines):
    """No energy is there that time steps could take."""
    glides = scene(*lines)
    result = result_of("large-motion", glides, SolutionCache(glides.beam))
    assert result.verdict.level == "trusted"
    assert measured(glides, "lag", model="fem", count=4) == pytest.approx(0.0, abs=1e-6 * L)


def test_too_few_links_and_elements_are_not_trusted():
    swung = scene("rotation = [0.0, 0.0, 0.9]", "[large-motion]", "links = 2", "elements = 3", "tolerance = 1e-4")
    ran = run_scene(swung)
    assert ran.verdict.level == "not trusted"
    assert ran.results["large-motion"].summary == ""


def test_the_steps_of_elements_damp_its_modes_as_chung_and_hulbert_state():
    shaken = scene("y = [0.0, 0.0, 0.3]")
    rows = result_of("large-motion", shaken, SolutionCache(shaken.beam)).tables[1].records()
    first, second = rows[0], rows[1]
    assert first["frequency"] == pytest.approx(1.8751040687**2 * UNIT / (2.0 * pi), rel=1e-3)
    assert second["ωh, elements"] / first["ωh, elements"] == pytest.approx((4.694091133 / 1.8751040687) ** 2, rel=2e-3)
    small = first["ωh, elements"]
    assert first["damping, elements"] == pytest.approx((0.2 / 1.8) ** 3 / 2.0 * small**3, rel=0.05 + small)
    assert rows[3]["damping, links"] < 1e-3 * rows[3]["damping, elements"]
    last = rows[-1]
    steps = 3.0 * 2.0 * pi * last["frequency"] / last["ωh, elements"]
    x, zeta = last["ωh, elements"], last["damping, elements"]  # per step exp(-zeta x) where zeta is small
    assert np.exp(-steps * zeta * x) == pytest.approx(0.5, abs=0.05)


def test_energy_that_long_steps_add_or_take_is_a_condition():
    fall = {"duration": 1.1, "gravity": [0.0, -0.9]}
    beam = {"length": 1.3, "bending_stiffness": 0.02, "mass_per_length": 0.8, "supports": ["pinned", "free"]}
    levels = []
    for tolerance in (1e-7, 3e-3):
        tables = {"name": "f", "beam": beam, "base": fall, "large-motion": {"tolerance": tolerance}}
        fell = scene_from(tables)
        margins = result_of("large-motion", fell, SolutionCache(fell.beam)).margins
        levels += [margin.level for margin in margins if "energy" in margin.name]
    assert levels[0] == "trusted"
    assert levels[1] != "trusted"


@BOTH
def test_a_base_that_turns_absurdly_fast_is_refused_before_it_takes_hours(model):
    with pytest.raises(InputError, match="duration"):
        measured(scene("rotation = [0.0, 0.0, 1e6]"), "lag", model=model, count=3)


def test_a_table_of_a_polynomial_moves_it_as_the_polynomial_does():
    times = np.linspace(0.0, 3.0, 13)
    values = 0.2 * times**2 - 0.03 * times**4
    table = f"{{ times = {times.tolist()}, values = {values.tolist()} }}"
    for name in ("rotation", "y"):
        scenes = [scene(f"{name} = {motion}") for motion in (table, "[0.0, 0.0, 0.2, 0.0, -0.03]")]
        tips = [measured(moved, "tip_y", model="segment", count=6, tolerance=1e-9) for moved in scenes]
        assert tips[0] == pytest.approx(tips[1], abs=1e-6)
        assert abs(tips[0]) > 0.01


def test_the_table_of_a_scene_with_a_base_is_its_large_motion_with_numbers_of_the_user(tmp_path, capsys):
    path = tmp_path / "my-blade.toml"
    path.write_text(BLADE + "y = [0.0, 0.0, 0.3]\n")
    words = ["table", str(path), "links=6", "elements=3", "--json"]
    assert status_of(words) == 0
    rows = json.loads(capsys.readouterr().out)["tables"][0]["rows"]
    assert [row["N"] for row in rows] == [6, 12, 3, 6]
    assert rows[3]["largest lag"] == pytest.approx(rows[1]["largest lag"], rel=0.05)


@pytest.mark.parametrize(
    ("lines", "beam", "text"),
    [
        (["rotation = { times = [0, 1, 2], values = [0, 1, 2] }"], "", r"base\.rotation.*six"),
        (["rotation = { times = [0, 1, 2, 3, 4, 5], values = [0, 1] }"], "", r"base\.rotation.*values"),
        (["hub_radius = -0.1"], "", "hub_radius"),
        (["gravity = [0.0, inf]"], "", "gravity"),
        (["rotaton = [0.0, 1.0]"], "", "rotation"),
        (["[drive]", "frequency_hz = 3.0", "force = [{ position = 0.2 }]"], "", "drive"),
        ([], "loss_factor = 0.02", "loss_factor"),
    ],
)
def test_what_no_moving_base_carries_is_refused(lines, beam, text):
    def run():
        blade = scene(*lines, beam=beam)
        result_of("large-motion", blade, SolutionCache(blade.beam))

    with pytest.raises(InputError, match=text):
        run()
