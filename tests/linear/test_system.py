"""The structural system by its verbs on a beam model, against dense matrices of textbook entries."""

import numpy as np
import pytest
from msgspec.structs import replace

from tests.beams import ARM, BEAMS, FORCES, HELD, MASSES, STRIP
from tests.reference.dense import Elements
from verify.analytic_modes import ExactModel
from verify.errors import InputError, ResonanceError
from verify.fem_beam import HermiteModel
from verify.problem.beam import Beam, PointForce
from verify.problem.device import Device
from verify.problem.point_attachments import PointMass, PointSpring
from verify.segment_model import SegmentModel

N, HERTZ = 13, 613.0
X = np.array([0.11, 0.29, 0.47, 0.68])
DEVICES = (
    Device(position=0.31, stiffness=2.1e3, dashpot=1.7, mass=2.9e-3, amplitude=0.7, phase_deg=23.0),
    Device(position=0.62, rotational=0.9, rotational_dashpot=3e-4),
)


def reference(beam: Beam, devices=()) -> Elements:
    """Dense matrices on the same nodes, which include those devices that act against rotation."""
    nodes = tuple(PointSpring(position=one.position, stiffness=1.0) for one in devices if one.turning)
    model = HermiteModel(replace(beam, spring=(*beam.spring, *nodes)), N)
    return Elements(beam, model.mesh.nodes * model.unit)


def with_devices(dense: Elements, devices, hertz):
    """Their dynamic stiffness over all unknowns."""
    omega = 2.0 * np.pi * hertz
    total = np.zeros(dense.mass.shape, dtype=complex)
    for device in devices:
        for z, derivative in ((device.dynamic_stiffness(omega), 0), (device.rotational_dynamic_stiffness(omega), 1)):
            row = dense.row(device.position, derivative)
            total += z * np.outer(row, row)
    return total


@pytest.mark.parametrize("name", BEAMS)
def test_all_modes_are_those_of_the_dense_matrices(name):
    model, dense = HermiteModel(BEAMS[name], N), reference(BEAMS[name])
    hertz = model.modes(model.n_elastic).frequencies_hz
    assert hertz == pytest.approx(dense.frequencies_hz(len(hertz)), rel=3e-9)  # LAPACK's on the assembled K
    assert hertz[4:] == pytest.approx(dense.frequencies_hz(len(hertz))[4:], rel=1e-11)


@pytest.mark.parametrize("name", ["clamped-free", "free-free", "masses-springs-steps", "compression", "losses"])
@pytest.mark.parametrize("devices", [(), DEVICES], ids=["alone", "with devices"])
def test_a_harmonic_response_with_devices_is_the_dense_one(name, devices):
    dense = reference(BEAMS[name], devices)
    found = HermiteModel(BEAMS[name], N).harmonic(FORCES, HERTZ, devices=devices)
    omega = 2.0 * np.pi * HERTZ
    forces = [*FORCES, *(one.own_force for one in devices)]
    solution = dense.harmonic(dense.load(forces), HERTZ, more=with_devices(dense, devices, HERTZ) / (1j * omega))
    for values, derivative in ((found.deflection(X), 0), (found.slope(X), 1)):
        expected = dense.values_at(solution, X, derivative)
        assert values == pytest.approx(expected, rel=1e-9, abs=1e-9 * abs(expected).max())


@pytest.mark.parametrize("name", ["free-free", "pinned-guided", "springs", "compression"])
def test_a_sweep_is_every_frequency_by_itself_rigid_body_share_included(name):
    beam, frequencies = BEAMS[name], [1.3, 2.9, 97.0, 211.0, 613.0, 1777.0]
    model, dense = HermiteModel(beam, N), reference(beam)
    sweep = model.harmonic(FORCES, frequencies).deflection(X)
    unit = model.receptance([0.37], frequencies, X)[:, 0]
    for i, hertz in enumerate(frequencies):
        expected = dense.values_at(dense.harmonic(dense.load(FORCES), hertz), X, 0)
        assert sweep[i] == pytest.approx(expected, rel=1e-8)
        assert model.harmonic(FORCES, hertz).deflection(X) == pytest.approx(expected, rel=1e-8)
        alone = dense.values_at(dense.harmonic(dense.load([PointForce(position=0.37)]), hertz), X, 0)
        assert unit[i] == pytest.approx(alone, rel=1e-8)


@pytest.mark.parametrize("devices", [(), DEVICES], ids=["alone", "with devices"])
def test_an_imposed_displacement_is_met_by_the_forces_that_impose_it(devices):
    drives = [PointForce(position=0.23, amplitude=3e-6, phase_deg=31.0), PointForce(position=0.59, amplitude=1e-6)]
    model, dense = HermiteModel(ARM, N), reference(ARM, devices)
    field = model.imposed(drives, HERTZ, devices=devices)
    given = [one.amplitude * np.exp(1j * np.deg2rad(one.phase_deg)) for one in drives]
    assert field.deflection([one.position for one in drives]) == pytest.approx(given, rel=1e-10)
    own = [one.own_force for one in devices]
    again = dense.harmonic(
        dense.load([*field.forces[:2], *own]), HERTZ, more=with_devices(dense, devices, HERTZ) / (2j * np.pi * HERTZ)
    )
    assert field.deflection(X) == pytest.approx(dense.values_at(again, X, 0), rel=1e-8)


@pytest.mark.parametrize(
    "name", ["pinned-pinned", "clamped-free", "clamped-guided", "stepped", "springs", "foundation"]
)
def test_buckling_loads_are_those_of_the_dense_matrices(name):
    dense = reference(BEAMS[name])
    assert HermiteModel(BEAMS[name], N).buckling_load() == pytest.approx(dense.buckling(dense.geometric), rel=1e-9)


def test_an_undamped_resonance_is_refused_and_a_damped_one_is_not():
    model = HermiteModel(HELD, N)
    third = float(model.modes(3).frequencies_hz[2])
    for frequencies in (third, [50.0, 60.0, 70.0, 80.0, third]):
        with pytest.raises(ResonanceError, match="is an undamped resonance of the fem model"):
            model.harmonic(FORCES, frequencies)
    assert np.isnan(model.receptance([0.3], [50.0, third], X)).all(axis=(1, 2)).tolist() == [False, True]
    assert abs(HermiteModel(replace(HELD, loss_factor=0.01), N).harmonic(FORCES, third).deflection(X)).max() < 1.0
    assert abs(model.harmonic(FORCES, third * (1.0 + 1e-6)).deflection(X)).max() > 1e-3


def test_a_resonance_of_beam_and_device_is_refused_and_the_beams_own_is_not():
    spring = Device(position=0.31, stiffness=2.1e3)
    coupled = replace(HELD, spring=(*HELD.spring, PointSpring(position=0.31, stiffness=2.1e3)))
    model = HermiteModel(HELD, 26)
    own, dense = float(model.modes(1).frequencies_hz[0]), Elements(coupled, model.mesh.nodes * model.unit)
    with pytest.raises(ResonanceError):
        model.harmonic(FORCES, float(dense.frequencies_hz(1)[0]), devices=spring)
    assert np.isfinite(model.harmonic(FORCES, own, devices=spring).deflection(X)).all()


@pytest.mark.parametrize(("count", "n_modes"), [(13, 20), (49, 8), (300, 5), (3000, 4)])
@pytest.mark.parametrize("foundation", [3.7e3, 1e11])
@pytest.mark.parametrize("model", [SegmentModel, HermiteModel])
def test_on_a_foundation_however_hard_every_mode_is_a_sum_of_two_stiffnesses(count, n_modes, foundation, model):
    """A foundation adds k_f / rho A to the square of every frequency of a uniform beam, of its parts too."""
    n_modes = min(n_modes, count - 1)
    bare = model(STRIP, count).modes(n_modes).frequencies_hz
    found = model(replace(STRIP, foundation=foundation), count).modes(n_modes).frequencies_hz
    lifted = np.hypot(bare, np.sqrt(foundation / STRIP.mass_per_length) / (2.0 * np.pi))
    assert found == pytest.approx(lifted, rel=2e-13)


@pytest.mark.parametrize("mass", [3e-6, 0.03, 3.0])
@pytest.mark.parametrize("model", [SegmentModel, HermiteModel])
def test_bodies_on_a_hard_foundation_lower_modes_of_their_own(model, mass):
    """Below many modes 2e-7 apart. With 49 parts they err by 20 and 50 %: the shape decays within half a part."""
    bodies = (PointMass(position=0.31, mass=mass), PointMass(position=0.57, mass=3e-4))
    beam = replace(STRIP, supports=("clamped", "free"), foundation=1e11, mass=bodies)
    few, every = (model(beam, 300).modes(n).frequencies_hz for n in (4, 299))
    assert few == pytest.approx(every[:4], rel=1e-12)
    assert few == pytest.approx(ExactModel(beam).modes(4).frequencies_hz, rel=4e-3)


@pytest.mark.parametrize("count", [13, 100, 300])
def test_all_modes_under_compression_keep_their_digits(count):
    """The dense way and Lanczos agree."""
    model = HermiteModel(replace(HELD, tension=-19.0, mass=MASSES), count)
    few, every = model.modes(5).frequencies_hz, model.modes(model.n_elastic).frequencies_hz
    assert every[:5] == pytest.approx(few, rel=1e-12)
    assert (np.diff(every) > 0.0).all()


def test_sizes_beyond_the_memory_are_refused_before_anything_is_built():
    elements = HermiteModel(STRIP, 10**5)
    for work in (lambda: HermiteModel(STRIP, 10**9), lambda: SegmentModel(STRIP, 10**9), lambda: elements.modes(10**5)):
        with pytest.raises(InputError, match="exceed the largest system of 10 GB"):
            work()
    for count, message in ((1, "at least 2"), (2.5, "whole number")):
        with pytest.raises(InputError, match=message):
            SegmentModel(STRIP, count)
    with pytest.raises(InputError, match="more than 2000"):
        HermiteModel(STRIP, 1100).time_basis()
    assert HermiteModel(replace(STRIP, supports=("free", "free")), 10**6).n_elastic == 2 * 10**6
