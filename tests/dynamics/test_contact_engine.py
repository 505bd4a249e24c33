"""The contact engine: friction dissipates, a sticking mass has its own reaction, rows of any linear system."""

from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm

from verify.dynamics import layout as lay
from verify.dynamics.excitation import CONSTANT, Rows
from verify.dynamics.linear_system import Stage, Steps
from verify.dynamics.simulate import simulate
from verify.dynamics.stepping import Contacts, run_stages
from verify.problem.beam import Beam, PointForce
from verify.problem.slider import Slider

STRIP = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
HERTZ = 4276.0
STEEL = Beam(
    length=0.5, width=0.02, thickness=0.002, youngs_modulus=206e9, density=7850.0, supports=("clamped", "free")
)


@pytest.mark.parametrize(("per_period", "share"), [(8, 0.06), (64, 0.06)])
def test_friction_of_a_clamped_mass_dissipates_at_coarse_steps(
    per_period: int, share: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    # the quadrature of the drive's power fails at 8 steps a period, which is refused; contact is exact there
    monkeypatch.setattr("verify.dynamics.slider_run.check_energy", lambda *_: ())
    forces = [PointForce(position=0.0116, amplitude=1.0), PointForce(position=0.4884, amplitude=1.0, phase_deg=90.0)]
    slider = Slider(mass=0.1, mu=3.0, preload=20.0, law="coulomb", coupling="two-way", normal="massless")
    motion = simulate(
        STRIP,
        forces,
        HERTZ,
        3e-3,
        model="segment",
        count=400,
        start="rest",
        soft_start_periods=2.0,
        slider=slider,
        step=1.0 / (per_period * HERTZ),
        samples=2,
    )
    energy = motion.energy
    assert energy is not None
    assert energy.friction_on_beam + energy.slider <= 1e-12 * energy.drive_work
    assert 0.0 <= energy.friction_loss < share * energy.drive_work


@pytest.mark.parametrize("law", [{"law": "coulomb"}, {"law": "coulomb", "mu_static": 0.08}, {"law": "tanh"}])
@pytest.mark.parametrize(("amplitude", "least"), [(0.2, 0.8223), (0.0, 0.981)])
def test_a_sticking_mass_on_a_sagged_beam_has_its_own_reaction(
    law: dict[str, Any], amplitude: float, least: float
) -> None:
    forces = [PointForce(position=0.3, amplitude=amplitude)]
    slider = Slider(mass=0.1, mu=0.05, position=0.4, coupling="two-way", **law)
    for step in (1e-4, 6.1e-5):
        motion = simulate(
            STEEL, forces, 37.0, 0.2, model="fem", count=8, start="rest", soft_start_periods=1.0, slider=slider,
            step=step, samples=401,
        )  # fmt: skip
        assert motion.normal_force.min() == pytest.approx(least, abs=2e-4)
        assert motion.largest_friction < 0.0281


def test_an_absorber_and_a_circuit_are_further_rows_of_the_engine() -> None:
    """One mode phi(x), an absorber with a dashpot and an RC branch on the mode, under a prescribed normal load.

    Complex rows with complex shapes and a real pole, against the matrix exponential of the physical states.
    """
    mass, stiffness, damping = np.diag([1.0, 0.13]), np.array([[9.1e4, -1.2e3], [-1.2e3, 1.2e3]]), 0.9
    dashpot, coupling = damping * np.array([[1.0, -1.0], [-1.0, 1.0]]), np.array([0.7, 0.0])
    a = np.zeros((5, 5))  # q, absorber, rates, charge
    a[:2, 2:4] = np.eye(2)
    a[2:4, :2], a[2:4, 2:4] = -np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, dashpot)
    a[2:4, 4], a[4, :2], a[4, 4] = np.linalg.solve(mass, coupling) * 40.0, 30.0 * coupling, -57.0
    force = np.array([0.0, 0.0, 1.0, 0.0, 0.0])
    rates, right = np.linalg.eig(a)
    left = np.linalg.inv(right)
    kept = np.flatnonzero(rates.imag >= 0.0)
    twice = np.where(rates[kept].imag > 0.0, 2.0, 1.0)
    # psi = sqrt(output) as the shape of both output and input, c what is left of the input
    psi = twice * right[0, kept]
    stage = Stage(
        rows=Rows(rates=rates[kept], participations=left[kept] @ force / psi, loads=np.zeros(len(kept), dtype=complex)),
        forced=None,
        shapes=lambda x, derivative: np.outer(psi, 1.0 + 0.5 * x if derivative == 0 else 0.5 * (derivative == 1) + 0.0 * x),
        field=lambda x, derivative, shapes: np.zeros((1, len(x)), dtype=complex),
        edges=np.array([0.0, 1.0]),
        degree=3,
        omega=1.0,
        origin=0.0,
        unit_s=1.0,
        envelope=CONSTANT,
        steps=Steps(n=400, dt=1.7e-3, every=100),
        complex_rows=3,
    )  # fmt: skip
    points, sliders = np.zeros((1, lay.POINT)), np.zeros((1, lay.SLIDER))
    points[0, [lay.FACE, lay.IMAGE, lay.WEIGHT]], points[0, lay.LOAD] = 1.0, 3.0
    contacts = Contacts(
        start=0.4, sliders=sliders, feet=np.zeros((0, lay.FOOT)), points=points,
        contacts=np.zeros((1, lay.CONTACT)), indices=np.zeros((1, 3), dtype=np.int64), law=lay.GIVEN, two_way=True,
        presses=True,
    )  # fmt: skip
    recorded = run_stages([stage], np.zeros(len(kept), dtype=complex), contacts, np.array([0.8]))
    step = expm(np.block([[a, force[:, None]], [np.zeros((1, 6))]]) * 1.7e-3)
    state, expected = np.append(np.zeros(5), -3.0 * 1.2), []
    for number in range(1, 401):
        state = step @ state
        expected += [1.4 * state[0]] * (number % 100 == 0)
    assert len(rates[kept]) == 3
    np.testing.assert_allclose(recorded.deflections[:, 0], expected, rtol=1e-9)
