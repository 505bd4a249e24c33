"""An inextensible rod without shear in space, curved at rest, clamped at one end, under dead loads: shooting by DOP853.

r' = d_1, d_i' = k x d_i with k = k_0 + m / K in the rod's own axes, m' = -d_1 x n, n' = -rho A g.
"""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root

NONE = np.zeros(3)


def hanging(length, stiffness, force, *, moment=NONE, weight=NONE, curvature=lambda s: NONE, steps=5):
    """(tip, elastic energy), the loads growing in `steps`; `stiffness`: GJ and both EI; `weight`: N/m."""
    force, moment, weight = np.array(force), np.array(moment), np.array(weight)

    def integrated(clamp, share):
        def rate(s, state):
            axes, couple = state[3:12].reshape(3, 3), state[12:15]
            own = axes.T @ couple
            turn = curvature(s) + own / stiffness
            pull = share * (force + (length - s) * weight)
            spin = np.cross(np.eye(3), turn)  # axes' = axes spin
            return np.concatenate(
                [axes[:, 0], (axes @ spin).ravel(), -np.cross(axes[:, 0], pull), [0.5 * own @ (own / stiffness)]]
            )

        start = np.concatenate([NONE, np.eye(3).ravel(), clamp, [0.0]])
        return solve_ivp(rate, (0.0, length), start, method="DOP853", rtol=1e-10, atol=1e-12).y[:, -1]

    clamp = np.zeros(3)
    for share in np.linspace(0.0, 1.0, steps + 1)[1:]:
        found = root(lambda couple, share=share: integrated(couple, share)[12:15] - share * moment, clamp, tol=1e-11)
        clamp = found.x
    end = integrated(clamp, 1.0)
    assert abs(end[12:15] - moment).max() <= 1e-7 * abs(clamp).max()
    return end[:3], end[15]
