"""What MuJoCo's control callback does, in machine code: forces on links, and friction on a slider.

What it reads and writes lies at addresses, `places`: of time, qpos, qvel, xfrc_applied, qfrc_applied; then how many
links, how many forces, and whether a slider rides. `numbers`: omega, a link's length, mu N, K, half a thickness, the
slider's start; then of each force its body, amplitude, phase, and lever about the body's middle.
"""

from math import cos, isfinite, tanh
from typing import Any

from verify.models.kernels import callback, numbers_at, part

PLACES, ROW = 8, 6
"""How many `places` there are; numbers of a body's applied force and moment."""
FORCE, EACH = 6, 4
"""Where forces begin among the numbers, and how many belong to one."""


@part()
def push(places: Any, numbers: Any) -> None:
    """All of it, at the time and in the motion that stand there now."""
    applied, count = numbers_at(places[3]), places[6]
    turned = numbers[0] * numbers_at(places[0])[0]
    for k in range(count):
        body = ROW * int(numbers[FORCE + EACH * k])
        applied[body + 2], applied[body + 4] = 0.0, 0.0
    for k in range(count):
        at = FORCE + EACH * k
        body, force = ROW * int(numbers[at]), numbers[at + 1] * cos(turned + numbers[at + 2])
        applied[body + 2] += force
        applied[body + 4] -= numbers[at + 3] * force
    if places[7]:
        rub(numbers_at(places[1]), numbers_at(places[2]), numbers_at(places[4]), places[5], numbers)


@part()
def rub(position: Any, speed: Any, applied: Any, links: Any, numbers: Any) -> None:
    """Friction on the slider, the coordinate after the links, by the surface under it (`case.surface_speed`)."""
    length = numbers[1]
    x = numbers[5] + position[links]
    i = min(max(int(x / length), 2), links - 3) if isfinite(x) else 2
    e = 0.0
    for j in range(i - 1):
        e += speed[j]
    f = e + speed[i - 1]
    g = f + speed[i]
    h = g + speed[i + 1]
    m = h + speed[i + 2]
    a, b, c, d = 0.5 * (e + f), 0.5 * (f + g), 0.5 * (g + h), 0.5 * (h + m)
    s = x / length - i
    cubic = 2.0 * b + s * (c - a + s * (2.0 * a - 5.0 * b + 4.0 * c - d + s * (3.0 * (b - c) + d - a)))
    applied[links] = -numbers[2] * tanh(numbers[3] * (speed[links] + 0.5 * numbers[4] * cubic))


def pushing(places: Any, numbers: Any) -> Any:
    """`push` on these two arrays, which have to live on, as a C function that the engine calls."""
    return callback(push, places, numbers)
