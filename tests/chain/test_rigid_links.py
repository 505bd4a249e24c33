"""The nonlinear chain of rigid links in time: against dense multiplier equations, conservation laws and closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from reference.multibody import by_multipliers, rigid_motion

from verify.chain.departure import DrivenChain
from verify.chain.kinematics import at_rest, place, project
from verify.chain.motion import simulate, step_limit
from verify.chain.rigid_links import accelerate, begin, flatten
from verify.chain.system import ChainState, ChainSystem, LinkLoad, build_system
from verify.errors import InputError
from verify.problem.beam import Beam, PointForce

STRIP = Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=68e9, density=2650.0)


def odd_chain(seed, n, **more):
    """Links, springs, dashpots and loads without any symmetry."""
    rng = np.random.default_rng(seed)
    lengths, masses, link = rng.uniform(0.02, 0.07, n), rng.uniform(0.01, 0.04, n), 1 + n // 2
    own = {
        "lengths": lengths,
        "masses": masses,
        "inertias": masses * lengths**2 * rng.uniform(0.05, 0.2, n),
        "stiffness": rng.uniform(0.5, 4.0, n),
        "dashpots": rng.uniform(0.0, 2e-3, n),
        "gravity": (0.7, -9.81),
        "hub_rate": 3.7,
        "loads": (
            LinkLoad(link=n, at=0.3 * lengths[-1], force=(0.2, -0.4), moment=0.013),
            LinkLoad(link=link, at=0.9 * lengths[link - 1], force=(-0.1, 0.5), frequency_hz=31.0, phase_deg=40.0),
        ),
    }
    return ChainSystem(**{**own, **more})


def some_state(system, seed):
    rng, n = np.random.default_rng(100 + seed), system.n_links
    return project(system, ChainState(rng.normal(0, 0.4, n), rng.normal(0, 5.0, n), 0.0137))


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000), st.integers(2, 14), st.sampled_from(["free", "roller", "sprung"]), st.booleans())
def test_accelerations_equal_the_multiplier_equations(seed, n, tip, axial):
    more = {"tip": "roller", "axial_spring": 57.0} if tip == "sprung" else {"tip": tip}
    system = odd_chain(seed, n, axial_inertia=axial, **more)
    try:
        state = some_state(system, seed)
    except InputError:
        assume(False)
    expected = by_multipliers(system, state.time, state.angles, state.rates)
    model = flatten(system)
    y = begin(system, state, model[2])
    out = np.zeros_like(y)
    accelerate(state.time, y, out, model)
    found = np.diff(out[n : 2 * n], prepend=0.0)
    assert abs(found - expected).max() <= 1e-9 * max(abs(expected).max(), 1e-3)


@pytest.mark.parametrize("method", [{"tolerance": 1e-10}, {"step": 2e-6}])
def test_motion_on_the_roller_equals_dense_integration(method):
    system = odd_chain(3, 5, tip="roller", hub_rate=0.0, gravity=(0.0, 0.0), dashpots=np.zeros(5))
    times = np.linspace(0.0, 0.02, 5)
    motion, seen = simulate(system, at_rest(system), times, **method), rigid_motion(system, 0.02)
    found = np.cumsum(system.lengths * np.sin(motion.directions()), axis=1)
    expected = np.array([seen(t)[0][1:] for t in times])
    assert found == pytest.approx(expected, abs=2e-7 * abs(expected).max())
    assert abs(found[:, -1]).max() < 1e-12


def test_fixed_steps_are_of_order_four():
    system, times = odd_chain(3, 5, tip="roller"), np.linspace(0.0, 0.02, 41)
    start, step = at_rest(system), 0.4 * step_limit(system)
    exact = simulate(system, start, times, tolerance=1e-13).angles
    coarse, fine = (abs(simulate(system, start, times, step=one).angles - exact).max() for one in (step, step / 2))
    assert 3.7 < np.log2(coarse / fine) < 4.3


def test_a_free_spinning_chain_keeps_its_angular_momentum():
    system = odd_chain(4, 5, stiffness=np.append(0.0, np.full(4, 1.3)), dashpots=np.full(5, 0.0), loads=(),
                       gravity=(0.0, 0.0), hub_rate=0.0)  # fmt: skip
    start = ChainState(np.array([0.1, 0.3, -0.2, 0.5, 0.1]), np.array([9.0, -3.0, 4.0, 1.0, 2.0]))
    motion = simulate(system, start, np.linspace(0.0, 0.3, 7), tolerance=1e-11)

    def momentum(state):
        _, _, joints, speeds = place(system, state.time, state.angles, state.rates)
        middles, moving = 0.5 * (joints[1:] + joints[:-1]), 0.5 * (speeds[1:] + speeds[:-1])
        spin = np.cumsum(state.rates)
        return system.masses @ (middles[:, 0] * moving[:, 1] - middles[:, 1] * moving[:, 0]) + system.inertias @ spin

    found = [momentum(motion.state(i)) for i in range(7)]
    assert found == pytest.approx([found[0]] * 7, rel=1e-8)
    assert np.sum(motion.energies(), axis=0) == pytest.approx(sum(motion.energies())[0], rel=1e-8)


def test_a_roller_chain_folds_over_its_base():
    system = odd_chain(2, 6, tip="roller", hub_rate=0.0, gravity=(-9.81, 0.0), loads=(), stiffness=np.zeros(6),
                       dashpots=np.zeros(6))  # fmt: skip
    start = at_rest(system, np.array([0.3, 0.4, 0.5, -0.9, -0.8, 0.1]))
    motion = simulate(system, start, np.linspace(0.0, 0.5, 41), tolerance=1e-10)
    tips = motion.joints()[:, -1]
    assert abs(tips[:, 1]).max() < 1e-8
    assert tips[:, 0].min() < 0.0 < tips[:, 0].max()
    total = np.sum(motion.energies(), axis=0)
    assert total == pytest.approx(total[0], abs=1e-7 * motion.energies()[0].max())


@pytest.mark.parametrize("damping", [0.02, 0.538])
def test_rk4_above_its_stability_limit_is_refused_and_below_it_stable(damping):
    """Damping ratio of the highest mode: at 0.538 its root meets the stability region where that is narrowest."""
    plain = build_system(STRIP, 15)
    omega = 2.0 * np.sqrt(2.0) / step_limit(plain)
    system = replace(plain, dashpots=plain.stiffness * 2.0 * damping / omega)
    limit = step_limit(system)
    bent = at_rest(system, 1e-3 * np.cos(np.arange(15.0)))
    with pytest.raises(InputError, match="stability limit"):
        simulate(system, bent, [0.01], step=1.02 * limit)
    motion = simulate(system, bent, np.linspace(0, 1000 * limit, 3), step=0.98 * limit)
    assert motion.statistics.finished
    assert abs(motion.angles).max() < 3 * abs(bent.angles).max()


def test_a_chaotic_motion_is_refused():
    strong = [PointForce(position=0.11, amplitude=2e5)]
    chain = DrivenChain(beam=STRIP, forces=strong, frequency_hz=700.0, count=6, load="reciprocal")
    with pytest.raises(InputError, match="does not converge"):
        chain.motion([4e-3, 8e-3], tolerance=1e-4)


def test_other_supports_and_losses_have_no_nonlinear_chain():
    for more in ({"supports": ("pinned", "clamped")}, {"loss_factor": 0.01}):
        beam = Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=68e9, density=2650.0, **more)
        with pytest.raises(InputError, match="nonlinear chain"):
            build_system(beam, 6)
