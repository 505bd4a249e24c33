"""Studies in time: slider, chain, motor."""

import pytest
from msgspec.structs import replace

from verify.errors import InputError
from verify.judge.cache import SolutionCache
from verify.quantities.base import evaluate
from verify.scene.load import load_scene
from verify.studies.axial_inertia import AxialInertia
from verify.studies.motion import Motion
from verify.studies.motor import Motor


def column(table, name):
    return [record[name] for record in table.records()]


SHORT = Motion(duration=8e-4, soft_start_periods=1.0, count=21, steps_per_period=32)
CHAIN = AxialInertia(forces=(0.5, 40.0), shown=20.0, count=12, duration=6e-4)
QUICK = Motor(models=("fem",), count=49, speeds=3, periods=20)


@pytest.fixture(scope="module")
def slider():
    """The paper's slider under a preload that keeps it on the surface."""
    scene = load_scene("paper-slider")
    return replace(scene.bare, slider=replace(scene.slider, preload=2.7, coupling="one-way"), studies={"motion": SHORT})


def test_displacements_equal_the_quantity(run, slider):
    cache, table = SolutionCache(slider.beam), run(slider, SHORT).tables[0]
    for row, arguments in zip(
        table.records(),
        ({"model": "analytic"}, {"model": "segment", "count": 21}, {"model": "fem", "count": 21}),
        strict=True,
    ):
        expected = evaluate("slider.displacement", arguments, slider, cache)
        assert row["displacement"] == pytest.approx(expected, rel=1e-3)  # samples cut its steps
        assert row["mean speed"] == pytest.approx(row["displacement"] / 8e-4, rel=1e-9)


def test_lift_off_voids_the_summary(run):
    free = load_scene("paper-slider")
    result = run(replace(free.bare, studies={"motion": SHORT}), SHORT)
    assert result.summary == ""
    assert "Lift-off" in result.warnings[0]
    assert "Coupling" in result.warnings[1]


def test_slider_renders(run, slider, renders):
    axes = renders(run(slider, SHORT))
    assert axes["slider-displacement"].get_xlabel() == "time, µs"
    assert axes["slider-friction"].get_ylabel().startswith("friction force, ")
    assert {line.get_label() for line in axes["slider-velocity"].lines} == {"surface under the slider", "slider"}


def test_wrong_options_are_refused():
    for study, change, word in (
        (Motion, {"duration": 0.0}, "motion.duration"),
        (Motion, {"start": "steady", "soft_start_periods": 1.0}, "soft_start_periods"),
        (Motion, {"modal_damping": 1.5}, "modal_damping"),
        (Motor, {"models": ("segmen",)}, "'segment'"),
        (AxialInertia, {"forces": (1.0, -1.0)}, "forces"),
    ):
        with pytest.raises(InputError, match=word):
            study(**change)


def test_departures_grow_with_the_square_of_the_force(run):
    scene = load_scene("chain")
    rows = run("chain", CHAIN).tables[0].records()
    assert [row["chain"] for row in rows[:3]] == ["rigid links", "without axial inertia", "stretching links"]
    arguments = {"force": 40.0, "segments": 12, "time": 6e-4, "inertia": "full"}
    expected = evaluate("chain.axial_departure", arguments, scene, SolutionCache(scene.beam))
    assert rows[3]["departure at the end"] == pytest.approx(expected, rel=1e-6)
    growth = (40.0 / 0.5) ** 2
    assert rows[3]["(kL)² ⟨θ²⟩"] / rows[0]["(kL)² ⟨θ²⟩"] == pytest.approx(growth, rel=0.05)
    assert rows[3]["departure, rms"] / rows[0]["departure, rms"] == pytest.approx(growth, rel=0.2)
    assert [row["linear"] for row in rows[::3]] == [True, False]


@pytest.mark.parametrize(
    ("study", "scene", "word"),
    [
        (AxialInertia(), "free-free-bar", "supports"),
        (AxialInertia(), "stick-slip-belt", "drive"),
        (Motor(), "paper-slider", "contact"),
        (Motion(), "stick-slip-belt", "drive"),
        (Motion(steps_per_period=99), "paper", "steps_per_period"),
    ],
)
def test_scenes_without_what_a_study_needs_are_refused(study, scene, word):
    with pytest.raises(InputError, match=word):
        study.check(load_scene(scene))


def test_motor_figures_equal_the_quantities(run):
    scene = load_scene("preloaded-motor")
    overview, held, _ = run("preloaded-motor", QUICK).tables
    cache = SolutionCache(scene.beam)
    first, arguments = overview.records()[0], {"model": "fem", "count": 49}
    for name, heading in (("stall_force", "stall force"), ("no_load_speed", "no-load speed")):
        expected = evaluate(f"slider.{name}", arguments, scene, cache)
        assert first[heading] == pytest.approx(expected, rel=1e-3)
    assert column(held, "speed") == pytest.approx([0.0, -0.5 * first["crest speed"], -first["crest speed"]])


def test_a_free_run_that_is_too_short_is_not_converged(run, renders):
    result = run("preloaded-motor", QUICK)
    assert result.summary == ""
    assert any("free run has no steady end" in warning for warning in result.warnings)
    assert column(result.tables[0], "free speed") == [None]
    axes = renders(result)
    assert axes["motor-force"].get_xlabel() == "speed, mm/s"
    assert "mu N" in [line.get_label() for line in axes["motor-force"].lines]
