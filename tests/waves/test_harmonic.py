"""Driven beams by all three models: superposition, reciprocity, imposed displacements, devices, damping, resonance."""

import numpy as np
import pytest
from msgspec.structs import replace

from tests.beams import BAR, BEAMS, DEVICES, FORCES, HELD, LADEN, MODELS, STRIP, close, over
from tests.reference.dense import phasor
from verify import Device, PointForce, PointMass, PointSpring, SegmentModel
from verify.errors import InputError, ResonanceError

X = np.array([0.13, 0.37, 0.58, 0.81])  # fractions of the length
PLACES = X * STRIP.length
HERTZ, EULER = 613.0, "euler-bernoulli"
DEVICE = Device(position=0.21, stiffness=310.0, mass=1.7e-3, dashpot=2.3, rotational=0.4, rotational_dashpot=3e-4)


SHEARED = replace(BAR, supports=("clamped", "free"), loss_factor=0.01, foundation=4e6)


@over(MODELS)
@pytest.mark.parametrize(
    ("beam", "theory"),
    [
        (BEAMS["clamped-free"], EULER),
        (BEAMS["free-free"], EULER),
        (LADEN["masses-springs-steps"], EULER),
        (LADEN["tension-masses"], EULER),
        (SHEARED, "rayleigh"),
        (SHEARED, "timoshenko"),
    ],
)
def test_sweeps_and_receptances_superpose_single_fields(name, beam, theory):
    model, x, hertz = MODELS[name](beam, theory=theory), X * beam.length, (1.3, 211.0, 613.0, 1409.0, 1777.0)
    forces = [replace(force, position=force.position / STRIP.length * beam.length) for force in FORCES]
    single = np.array([model.harmonic(forces, f).deflection(x) for f in hertz])
    sweep = model.harmonic(forces, hertz)
    assert sweep.deflection(x) == pytest.approx(single, rel=1e-8)
    assert sweep.at(2).deflection(x) == pytest.approx(single[2], rel=1e-8)
    units = model.receptance([force.position for force in forces], hertz, x)
    phasors = [phasor(force) for force in forces]
    assert np.einsum("i,fix->fx", phasors, units) == pytest.approx(single, rel=1e-7)


@over(MODELS)
@pytest.mark.parametrize(("loss_factor", "devices"), [(0.0, DEVICE), (0.013, DEVICE), (0.0, ()), (0.0, DEVICES)])
def test_forces_of_imposed_displacements_impose_them(name, loss_factor, devices):
    model = MODELS[name](replace(LADEN["stepped"], loss_factor=loss_factor))
    drives = [PointForce(position=0.17, amplitude=2e-6), PointForce(position=0.53, amplitude=3e-6, phase_deg=71.0)]
    field = model.imposed(drives, HERTZ, devices=devices)
    by_forces = model.harmonic(field.forces[:2], HERTZ, devices=devices)
    for one in (field, by_forces):
        assert one.deflection([0.17, 0.53]) == pytest.approx([2e-6, 3e-6 * np.exp(1j * np.deg2rad(71.0))], rel=1e-8)
    close(by_forces.deflection(PLACES), field.deflection(PLACES))


# --- Damping and resonance -------------------------------------------------------------------------------------------


@over(["segment", "fem"])
def test_a_loss_factor_half_a_modal_ratio_and_a_joint_dashpot_damp_a_resonance_alike(name):
    eta, force = 0.004, PointForce(position=0.111)
    model = MODELS[name](STRIP, 60)
    hertz = float(model.modes(3).frequencies_hz[2])
    by_loss = MODELS[name](replace(STRIP, loss_factor=eta), 60).harmonic(force, hertz).deflection(PLACES)
    close(model.harmonic(force, hertz, modal_damping=eta / 2).deflection(PLACES), by_loss, 0.002)
    if name == "segment":
        dashpot = eta * STRIP.bending_stiffness / (STRIP.length / 60) / (2 * np.pi * hertz)
        by_dashpot = SegmentModel(STRIP, 60, joint_dashpot=dashpot).harmonic(force, hertz).deflection(PLACES)
        close(by_dashpot, by_loss, 1e-10)


@over(MODELS)
@pytest.mark.parametrize("theory", [EULER, "rayleigh", "timoshenko"])
def test_an_undamped_resonance_is_refused_within_3e_10(name, theory):
    beam, x = HELD if theory == EULER else replace(BAR, supports=("clamped", "pinned")), np.array([0.31])
    model, force = MODELS[name](beam, theory=theory), PointForce(position=0.1)
    third = float(model.modes(3).frequencies_hz[2])
    for frequencies in (third, third * (1 + 3e-10), third * np.linspace(0.5, 1.0, 6)):
        mode = "of mode 3 " if name == "exact" else ""
        with pytest.raises(ResonanceError, match=rf"resonance.* {mode}of the {model.name} model"):
            model.harmonic(force, frequencies)
    gaps = np.isnan(model.receptance([0.3], [0.7 * third, third], x)).all(axis=(1, 2))
    assert gaps.tolist() == [False, True]
    below, above = (model.harmonic(force, third * (1 + side * 1e-7)).deflection(x)[0].real for side in (-1, 1))
    assert below / above == pytest.approx(-1.0, rel=2e-4)
    damped = MODELS[name](replace(beam, loss_factor=0.01), theory=theory).harmonic(force, third)
    assert 0.0 < abs(damped.deflection(x)[0]) < 1e-3 * abs(below)


@over(MODELS)
def test_the_resonance_of_beam_and_device_is_refused_and_that_of_the_beam_is_not(name):
    device = Device(position=0.31, mass=0.2, stiffness=2.1e3, rotational=3.0)
    spring = PointSpring(position=0.31, stiffness=2.1e3, rotational=3.0)
    laden = replace(HELD, spring=(spring,), mass=(PointMass(position=0.31, mass=0.2),))
    resonance = float(MODELS[name](laden, *([] if name == "exact" else [30])).modes(3).frequencies_hz[2])
    model = MODELS[name](HELD, *([] if name == "exact" else [30]))
    with pytest.raises(ResonanceError, match="of mode 3 .*with its devices" if name == "exact" else "resonance"):
        model.harmonic(FORCES, resonance, devices=device)
    for hertz in (resonance * (1 + 3e-9), float(model.modes(1).frequencies_hz[0])):
        assert np.isfinite(model.harmonic(FORCES, hertz, devices=device).deflection(PLACES)).all()


@pytest.mark.parametrize("name", ["exact", "fem"])
def test_the_resonance_of_a_beam_fixed_at_its_actuators_is_refused(name):
    """An imposed displacement at a free end is a pinned end."""
    arm, fixed = (replace(STRIP, supports=("clamped", end)) for end in ("free", "pinned"))
    resonance, drive = float(MODELS[name](fixed).modes(2).frequencies_hz[1]), PointForce(position=0.73, amplitude=1e-6)
    with pytest.raises(ResonanceError, match="resonance"):
        MODELS[name](arm).imposed(drive, resonance * (1 - 3e-10))
    for loss, off in ((0.0, 1e-6), (1e-4, 0.0)):
        field = MODELS[name](replace(arm, loss_factor=loss)).imposed(drive, resonance * (1 + off))
        assert np.isfinite(field.deflection(PLACES)).all()


@over(MODELS)
@pytest.mark.parametrize(
    ("forces", "hertz", "message"),
    [
        (FORCES, float("nan"), "frequency_hz = nan"),
        (FORCES, 0.0, "frequency_hz = 0"),
        ((), 100.0, "give a PointForce"),
        (PointForce(position=0.74), 100.0, r"force\.position = 0\.74 lies off the beam"),
    ],
)
def test_a_drive_without_frequency_or_force_on_the_beam_is_an_input_error(name, forces, hertz, message):
    with pytest.raises(InputError, match=message):
        MODELS[name](STRIP).harmonic(forces, hertz)


@over(MODELS)
def test_two_displacements_at_the_same_place_or_on_a_support_are_an_input_error(name):
    for second in (FORCES[0].position, STRIP.length):
        with pytest.raises(InputError, match="imposed"):
            MODELS[name](STRIP).imposed((FORCES[0], PointForce(position=second)), 411.0)
