"""A rope that slips over a drum: its tensions are as e^(mu phi) (Euler and Eytelwein), a chain's converge to it.

Massless links are hinged at N contacts at equal angles, with the free ends along the tangents of the angles 0 and phi.
At each contact the chain turns by phi/N; the sum of two tensions bears the normal force, their difference friction.
"""

from math import cos, exp, sin

from verify.cases.base import case

EYTELWEIN = "A. E. Eytelwein, Handbuch der Statik fester Koerper (1808): mu over every turn"


@case("capstan", exp(0.23 * 3.5), 1e-15, EYTELWEIN, mu=0.23, wrap=3.5)
def tension_ratio(mu: float, wrap: float, count: int = 64) -> float:
    """Tension of the held end over that of the pulled end by a chain of `count` contacts; `wrap`: radians. Order 2."""
    half = 0.5 * wrap / count
    held = 1.0
    for _ in range(count):  # (held' - held) cos = mu (held' + held) sin
        held *= (cos(half) + mu * sin(half)) / (cos(half) - mu * sin(half))
    return held
