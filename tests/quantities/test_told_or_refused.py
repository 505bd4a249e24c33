"""Figures that hang on what nobody asked for, a corner or a start, are of what was asked, or refused."""

import json

import pytest

SCENE = """name = "told"
title = "a strip with a device"

[beam]
length = 0.9
width = 0.02
thickness = 0.002
youngs_modulus = 206e9
density = 7850.0
supports = ["free", "free"]

[drive]
frequency_hz = 2100.0
force = [{ position = 0.02 }]
"""
LOSSY = SCENE.replace("frequency_hz = 2100.0", "frequency_hz = 1730.0").replace(
    'supports = ["free", "free"]', 'supports = ["pinned", "pinned"]\nloss_factor = 0.03'
)


@pytest.fixture
def measured(verify, tmp_path):
    """(figure or None, what was said) of a quantity of a scene."""

    def ask(scene, name, *given):
        (tmp_path / "told.toml").write_text(scene)
        status, out, err = verify("measure", "told.toml", name, *given, "--json")
        return (None if status else json.loads(out)["value"]), err

    return ask


# --- Devices beside an absorber --------------------------------------------------------------------------------------

OTHER = "[[drive.device]]\nposition = {}\ndashpot = 60.0\nmass = 0.05\n"
ABSORBING = ("wave.absorber_reflection", "model=analytic", "position=0.07", "ratio=1.4")


def test_an_absorbers_beam_keeps_its_other_devices(measured):
    """One between force and window sends no wave through it from the right; behind the absorber it is felt."""
    alone, _ = measured(SCENE, *ABSORBING)
    behind, _ = measured(SCENE + OTHER.format(0.88), *ABSORBING)
    before, _ = measured(SCENE + OTHER.format(0.11), *ABSORBING)
    assert alone == pytest.approx((1.4 - 1.0) / (1.4 + 1.0), rel=1e-5)
    assert behind > 1.2 * alone or behind < 0.8 * alone
    assert before == pytest.approx(alone, rel=1e-4)
    same, _ = measured(SCENE + OTHER.format(0.83), *ABSORBING)
    assert same == alone  # the absorber stands in its place


def test_a_device_in_the_window_of_an_absorber_is_refused(measured):
    """Two waves are not alone on both sides of it; a plan knows it too."""
    value, said = measured(SCENE + OTHER.format(0.3), *ABSORBING)
    assert value is None
    assert "[0.02, 0.3, 0.83]" in said
    value, said = measured(
        SCENE + OTHER.format(0.3).replace("dashpot", "rotational_dashpot").replace("mass = 0.05\n", ""), *ABSORBING
    )
    assert value is None
    assert "holds a device against turning at [0.3] m" in said


# --- Energies of a corner ---------------------------------------------------------------------------------------------

PLUCKED = ("motion.released_energy", "model=segment", "place=0.2", "height=1e-3")


@pytest.mark.parametrize("of", ["elastic", "kinetic"])
def test_energies_that_grow_with_the_parts_of_a_model_are_refused(measured, of):
    value, said = measured(LOSSY, *PLUCKED, "count=40", "time=0.0123", "modal_damping=0", f"of={of}")
    assert value is None
    assert f"% of the {of} energy is then in the faster half of the modes" in said
    settled = [
        measured(LOSSY, *PLUCKED, f"count={n}", "time=0.2", "modal_damping=0.03", f"of={of}")[0] for n in (40, 80)
    ]
    assert settled[0] == pytest.approx(settled[1], rel=0.02)


def test_what_is_thrown_along_lines_has_an_energy_at_once(measured):
    value, _ = measured(
        LOSSY, "motion.released_energy", "model=fem", "count=40", "place=0.2", "speed=0.3", "time=1e-9", "of=kinetic"
    )
    assert value == pytest.approx(0.5 * 7850.0 * 0.02 * 0.002 * 0.9 / 3.0 * 0.3**2, rel=1e-3)


# --- Waves of a motion that has had a start ---------------------------------------------------------------------------

STEADY = ("motion.reflection", "model=fem", "count=80", "window=[0.2, 0.5]")


def test_the_last_periods_of_a_motion_are_those_of_a_steady_one(measured):
    steady, _ = measured(LOSSY, *STEADY, "time=0.01", "start=steady")
    late, _ = measured(LOSSY, *STEADY, "time=0.08", "periods=15")
    whole, _ = measured(LOSSY, *STEADY, "time=0.08")
    assert late == pytest.approx(steady, rel=1e-3)
    assert abs(whole / steady - 1.0) > 10.0 * abs(late / steady - 1.0)
    assert "the motion has 138.4 of them" in measured(LOSSY, *STEADY, "time=0.08", "periods=139")[1]


# --- Arguments beyond what numbers bear -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "given", "said"),
    [
        ("slider.layer_force", ("contact_half_angle=1e-9", "speed_ratio=0.3"), "contact_half_angle = 1e-09"),
        ("slider.layer_force", ("contact_half_angle=1e-9", "speed_ratio=0.3", "epsilon=0.1"), "contact_half_angle"),
        ("chain.large_amplitude_frequency", ("segments=20", "amplitude=1e-12"), "amplitude = 1e-12 radii of gyration"),
        ("chain.large_amplitude_frequency", ("segments=20", "amplitude=1e-300"), "amplitude = 1e-300 radii"),
        ("friction.coulomb_decrement", ("mass=1", "stiffness=1e300", "force=1e300"), "stiffness = 1e+300"),
        (
            "friction.belt_slip_time",
            ("mass=1e-300", "stiffness=1e300", "static=10", "kinetic=0.1", "speed=1e300"),
            "mass = 1e-300",
        ),
    ],
)
def test_what_numbers_do_not_bear_is_refused_with_its_name(measured, name, given, said):
    value, err = measured(LOSSY, name, *given)
    assert value is None
    assert said in err
    assert err.count("\n") == 1


@pytest.mark.parametrize("time", ["1e3", "1e5", "1e12"])
def test_a_chain_that_would_be_kept_too_often_is_refused_before_it_is_laid_out(measured, time):
    slid = LOSSY + '[slider]\nmass = 1e-4\nmu = 0.2\nslope = 50\ncoupling = "one-way"\nposition = 0.31\n'
    value, err = measured(
        slid.replace("loss_factor = 0.03\n", ""), "chain.slider_displacement", "segments=3", f"time={time}"
    )
    assert value is None
    assert "states of 3 links" in err


AT_ONCE = """name = "told"

[beam]
length = 0.42
width = 0.012
thickness = 0.004
youngs_modulus = 205e9
density = 7830.0
supports = ["clamped", "free"]

[drive]
frequency_hz = 130.0
force = [{ position = 0.31, amplitude = 20.0, phase_deg = -60.0 }, { position = 0.37, amplitude = 13.0 }]

[slider]
mass = 0.002
mu = 0.3
slope = 40
position = 0.2003
preload = 0.5
coupling = "one-way"
"""


def test_the_largest_friction_on_a_chain_is_of_a_run_whose_books_close(measured):
    """Forces that act at once excite modes that turn within the drive's steps."""
    asked = ("chain.slider_largest_friction", "segments=41", "time=0.03")
    value, said = measured(AT_ONCE, *asked)
    assert value is None
    assert "% of what is rubbed away, so that its largest friction is not known; give a shorter step" in said
    coarse, fine = (measured(AT_ONCE, *asked, f"step={step}")[0] for step in (8e-6, 2e-6))
    assert coarse == pytest.approx(fine, rel=3e-3)
