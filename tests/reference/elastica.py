"""Planar elasticae by shooting: independent of every model of the suite."""

from math import cos, sin

from scipy.integrate import solve_ivp


def follower_tip(force):
    """Tip (x, y)/L and rotation of a cantilever, EI = L = 1, under a follower force across its tip.

    Seen from the tip, whose tangent is the axis, the force has a constant direction: kappa' = force cos(phi) there,
    with the angle phi of the beam to the tip's tangent; integrated from the tip to the clamp without shooting.
    """
    rates = lambda s, y: [y[1], -force * cos(y[0]), cos(y[0]), sin(y[0])]  # noqa: E731
    turn, _, along, across = solve_ivp(rates, (0.0, 1.0), [0.0] * 4, rtol=1e-12, atol=1e-14).y[:, -1]
    # at s = 1 the clamp: its tangent has the angle `turn` to the tip's; the tip lies at (along, across) reversed
    angle = -turn
    return (along * cos(angle) - across * sin(angle), along * sin(angle) + across * cos(angle)), angle
