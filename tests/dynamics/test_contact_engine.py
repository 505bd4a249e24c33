"""The contact engine on the rows of any linear system."""

import numpy as np
from scipy.linalg import expm

from verify.dynamics import layout as lay
from verify.dynamics.excitation import CONSTANT, Rows
from verify.dynamics.linear_system import Stage, Steps
from verify.dynamics.stepping import Contacts, run_stages


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
        contacts=np.zeros((1, lay.CONTACT)), indices=np.zeros((1, 3), dtype=np.int64), law=lay.PRESCRIBED, two_way=True,
        normal_two_way=True,
    )  # fmt: skip
    recorded = run_stages([stage], np.zeros(len(kept), dtype=complex), contacts, np.array([0.8]))
    step = expm(np.block([[a, force[:, None]], [np.zeros((1, 6))]]) * 1.7e-3)
    state, expected = np.append(np.zeros(5), -3.0 * 1.2), []
    for number in range(1, 401):
        state = step @ state
        expected += [1.4 * state[0]] * (number % 100 == 0)
    assert len(rates[kept]) == 3
    np.testing.assert_allclose(recorded.deflections[:, 0], expected, rtol=1e-9)
