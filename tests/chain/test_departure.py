"""Departure of the nonlinear chain from the linear one by axial inertia, and its contact line."""

import numpy as np
import pytest
from msgspec import structs
from reference.multibody import rigid_motion

from verify.analysis.solution_cache import SolutionCache
from verify.chain.departure import DrivenChain, linear_deflection, rms
from verify.chain.system import build_system
from verify.dynamics.arguments import Excitation, Keep
from verify.dynamics.simulate import simulate
from verify.errors import InputError
from verify.problem.beam import Beam, PointForce
from verify.quantities.base import evaluate
from verify.scene.model import Drive, Scene, SceneForce

STRIP = Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=68e9, density=2650.0)
PLATE = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
HERTZ, TIME = 4276.0, 1e-3


def forces(amplitude):
    return (
        PointForce(position=0.0116, amplitude=amplitude, phase_deg=-90.0),
        PointForce(position=0.4871, amplitude=1.3 * amplitude),
    )


def driven(forces, n, beam=PLATE, **settings):
    return DrivenChain(beam=beam, forces=forces, frequency_hz=HERTZ, count=n, **settings)


@pytest.mark.parametrize("supports", [("pinned", "pinned"), ("clamped", "free"), ("clamped", "pinned")])
@pytest.mark.parametrize(("n", "x"), [(50, 0.0613), (13, 0.2917)])
def test_deflection_at_small_forces_is_that_of_the_linear_segment_model(supports, n, x):
    beam = structs.replace(PLATE, supports=supports)
    linear = simulate(beam, Excitation(forces(1.0), HERTZ), 9e-4, count=n, start="rest", keep=Keep(at=x, samples=2))

    def gap(amplitude, **options):
        force = tuple(SceneForce(**structs.asdict(one)) for one in forces(amplitude))
        scene = Scene(name="chain", beam=beam, drive=Drive(frequency_hz=HERTZ, kind="force", force=force))
        arguments = {"segments": n, "time": 9e-4, "x": x, **options}
        chain = evaluate("chain.transient_deflection", arguments, scene, SolutionCache(beam))
        return abs(chain / (amplitude * linear.deflection[-1, 0]) - 1.0)

    small, larger = gap(0.05), gap(0.2)
    assert small < 1e-5
    assert larger < 25.0 * small + 1e-6  # of order 2 in the force
    assert min(gap(0.2, reading="links"), gap(0.2, load="lever")) > 10.0 * larger


def test_the_linear_chain_is_the_limit_of_small_forces():
    system, times = build_system(PLATE, 9, forces(1e-3), HERTZ), np.linspace(0.0, 3e-4, 7)
    exact, nodes = rigid_motion(system, 3e-4), np.linspace(0.0, 0.5, 10)
    expected = np.array([np.interp(0.23, nodes, exact(t)[0]) for t in times])
    assert linear_deflection(system, times, 0.23) == pytest.approx(expected, abs=1e-6 * abs(expected).max())


@pytest.mark.parametrize("inertia", ["full", "elastic"])
def test_departure_grows_with_the_square_of_the_force(inertia):
    small, large = (driven(forces(size), 17, inertia=inertia).departure(TIME, 0.23)[1] for size in (1.0, 4.0))
    assert large / small == pytest.approx(16.0, rel=0.05)
    assert small > 1e-8


def test_stiff_links_tend_to_rigid_ones_with_the_inverse_of_their_stiffness():
    def deflection(beam, inertia):
        chain = driven(forces(60.0), 9, beam, load="reciprocal", inertia=inertia)
        return chain.motion(np.linspace(0.0, 4e-4, 101)).deflection([0.23])[:, 0]

    gaps = []
    for factor in (40.0, 400.0):  # EA over EI as the inverse square of the thickness
        thin = {"thickness": PLATE.thickness / factor**0.5, "width": PLATE.width * factor**0.5}
        stiff = structs.replace(PLATE, **thin, youngs_modulus=factor * PLATE.youngs_modulus)
        assert stiff.bending_stiffness == pytest.approx(PLATE.bending_stiffness)
        gaps.append(rms(deflection(stiff, "elastic") - deflection(stiff, "full")))
    assert gaps[0] / gaps[1] == pytest.approx(10.0, rel=0.3)


def test_a_departure_at_a_node_is_refused():
    symmetric = [PointForce(position=x, amplitude=s) for x, s in ((0.1, 1.0), (0.4, -1.0))]
    with pytest.raises(InputError, match="do not move"):
        driven(symmetric, 8).departure(2e-4)


@pytest.mark.parametrize(("support", "x", "expected"), [("pinned", 0.2, 3.0), ("clamped", 0.003, 1.0)])
def test_the_contact_lines_slope_converges_inside_with_order_three_and_at_a_wall_with_one(support, x, expected):
    beam = structs.replace(PLATE, supports=(support, "pinned"))
    line, scene = "chain.contact_line_error", Scene(name="line", beam=beam)
    sizes = [{"segments": n, "mode": 3, "x": x} for n in (20, 40, 80)]
    errors = [evaluate(line, size, scene, SolutionCache(beam)) for size in sizes]
    assert np.log2(errors[0] / errors[2]) / 2 == pytest.approx(expected, abs=0.6)
