"""What captions of charts say is so on the scene at hand: under another load, law or surface they say something else."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify.attached import PointMass
from verify.errors import WindowError
from verify.quantities.catalogue import QUANTITIES, arguments_of, evaluate
from verify.run.runner import run_scene, workbench_for
from verify.run.tables import study_of
from verify.scenes.scene import load_scene
from verify.studies.axial_charts import _off
from verify.studies.axial_figures import AxialFound, Departure, ForceRow
from verify.studies.sensitivity import Sensitivity
from verify.studies.sensitivity_figures import sensitivity
from verify.studies.slider_movie import _way
from verify.words import work_in_words


def charts_of(scene, study, *overrides):
    """By their ids."""
    found = study_of(load_scene(scene, overrides), study).run(lambda step: None)
    return {chart.id: chart.caption for chart in found.charts()}


def test_modulus_and_density_move_a_bare_beam_by_half_and_a_laden_one_by_what_was_solved():
    bare = load_scene("paper").beam
    (plain,) = sensitivity(bare, Sensitivity(mode=2)).charts()
    assert "one per cent of modulus or density moves mode 2 by half a per cent." in plain.caption
    mass = 0.3 * bare.mass_per_length * bare.length
    taut = replace(bare, tension=310.0, mass=(PointMass(position=0.11, mass=mass),))
    found = sensitivity(taut, Sensitivity(mode=2))
    middle = found.frequencies_hz[2][12]
    step = found.moduli[13] / found.moduli[12]
    stiff = np.log(found.frequencies_hz[2][13] / middle) / np.log(step)
    assert 0.0 < stiff < 0.2
    (chart,) = found.charts()
    assert "does not go with sqrt(E / rho)" in chart.caption
    told = float(chart.caption.partition("moves mode 2 by ")[2].split()[0])
    assert told == pytest.approx(stiff, rel=0.02)
    assert "half a per cent" not in chart.caption


@pytest.mark.parametrize(
    ("law", "said"), [("tanh", "slider and surface pass each other faster than 1/K"), ("coulomb", "while it sticks")]
)
def test_friction_is_said_to_hang_on_the_speed_between_slider_and_surface(law, said):
    scene = load_scene("paper-slider", ("motion.counts=[9, 13]", "motion.count=11", "motion.duration=6e-4"))
    scene = replace(scene, gate=(), claim=(), readings=None, slider=replace(scene.slider, law=law))
    caption = next(one.caption for one in run_scene(scene).found["motion"].charts() if one.id == "slider-force")
    assert said in caption
    assert "as soon as the surface moves" not in caption


class Ride:
    """A run by its places alone."""

    points = np.linspace(0.0, 0.5, 50)

    def __init__(self, *places):
        self.position = np.array(places)


def test_a_slider_that_goes_along_the_beam_is_not_said_to_stand():
    assert _way(Ride(0.25, 0.2500002)).endswith("too little to be seen")
    assert _way(Ride(0.1, 0.1999, 0.15)) == "Along the beam the slider moves over 99.9 mm"


@pytest.mark.parametrize(("fibre", "slivers"), [(0.0005, True), (0.02, False)])
def test_ellipses_that_lie_flat_are_no_slivers(fibre, slivers):
    caption = charts_of("paper-wave", "wave", f"beam.extreme_fibre={fibre}")["wave-ellipses"]
    assert ("slivers" in caption) == slivers
    assert slivers or "times as wide as high" in caption


def test_chains_are_told_how_far_they_lie_off_the_linear_one():
    """Links that stretch may lie farther off than rigid ones."""
    one = {"rms": 1e-4}
    row = ForceRow(
        force=10.0,
        deflection_rms=1e-4,
        size=1e-3,
        linear=False,
        full=Departure(at_end=1.24e-3, **one),
        transverse=Departure(at_end=3e-5, **one),
        elastic=Departure(at_end=2.3e-3, **one),
        along=(1e-4, 2e-3),
    )
    found = AxialFound(rows=(row,), beside=(), times=(), lines={}, shown=10.0, count=20, duration=1e-3, x=0.1)
    assert "rigid links 1.2e-03, without axial inertia 3.0e-05, links that stretch 2.3e-03" in _off(found)
    assert _off(replace(found, shown=3.0)) == ""


@pytest.mark.parametrize(
    ("quantity", "told"),
    [
        ("chain.hanging_frequency", "1 equilibria and modes of the nonlinear chain"),
        ("chain.rollup_gap", "1 equilibria and modes of the nonlinear chain"),
        ("friction.creep_speed", "closed forms only"),
    ],
)
def test_an_equilibrium_of_the_nonlinear_chain_is_no_closed_form(quantity, told):
    scene = load_scene("chain" if quantity.startswith("chain") else "paper-slider")
    bench, kind = workbench_for(scene, gates_only=True), QUANTITIES[quantity]
    gate = next(one for one in scene.gate if one.quantity == quantity)
    evaluate(kind, arguments_of(kind, gate.arguments), scene, bench)
    assert work_in_words(len(bench.solves), bench.n_fields, bench.n_motions, bench.others) == told


def test_a_wave_study_names_a_remedy_that_it_has():
    """It reads the middle half of the beam, and has no window to choose."""
    stepped = ["beam.section=[{length=0.33}, {length=0.17, thickness=0.002}]"]
    with pytest.raises(
        WindowError, match=r"leave \[wave\] out, and ask for figures by gates with a window of their own"
    ):
        run_scene(replace(load_scene("paper-wave", tuple(stepped)), gate=(), claim=()))
