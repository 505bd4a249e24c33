"""Friction of a slider from its speed over time: free decay, breakaway under a growing force, a run on the beam.

On a surface at rest, with g the normal force N over the mass, for v > 0:

- Eq. (3), m dv/dt = -mu N tanh(K v): sinh(K v) = sinh(K v0) e^{-mu g K t};
- Coulomb's law: v = max(v0 - mu g t, 0), a constant deceleration;
- Coulomb's law under a force r t: rest until t_b = mu_s N/r, then v = r (t^2 - t_b^2)/(2m) - mu g (t - t_b).
"""

from collections.abc import Callable, Sequence
from math import copysign
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array
from verify.errors import InputError
from verify.identify.fit import Model, Parameter, Values
from verify.problem.slider import Slider

LABELS = ("time", "s"), ("speed", "m/s")


def known(slider: Slider, *names: str) -> dict[str, Parameter]:
    """Parameters of a slider; `slope` is K, s/m, `speed` the initial one. Raises InputError for a friction of zero."""
    static = slider.mu if slider.mu_static is None else slider.mu_static
    parameters = {
        "mu": Parameter(slider.mu, "", 1e-6, 10.0),
        "mu_static": Parameter(static, "", 1e-6, 10.0),
        "slope": Parameter(slider.steepness or 0.0, "s/m", 1e-3, 1e7),
        "speed": Parameter(slider.speed, "m/s"),
    }
    for name, one in parameters.items():
        if name in names and not one.lower <= one.value <= one.upper:
            raise InputError(f"slider.{name} = {one.value!r} cannot start a fit: give another")
    return {name: parameters[name] for name in names}


def decay(slider: Slider, times: Array) -> Model:
    """Speed of a slider that slides freely on a beam at rest, by its friction law. Raises InputError without speed."""
    g = slider.normal_force / slider.mass
    if slider.speed == 0.0:
        raise InputError("slider.speed = 0.0: a free decay needs an initial speed, give it in m/s")

    def tanh(values: Values) -> tuple[Array, dict[str, Array]]:
        mu, slope, sign, start = values["mu"], values["slope"], copysign(1.0, values["speed"]), abs(values["speed"])
        steep = slope * max(start, 1e-12)
        log = steep + np.log(-0.5 * np.expm1(-2.0 * steep)) - mu * g * slope * times  # ln sinh(K v): K v0 may be 1e3
        small = np.exp(-abs(log))
        v = np.where(log > 0.0, log + np.log1p(np.sqrt(1.0 + small**2)), np.arcsinh(small)) / slope
        slip, ratio = np.tanh(slope * v), 1.0 / np.tanh(steep)
        by_slope = -v / slope + slip * (start * ratio - mu * g * times) / slope
        return sign * v, {"mu": -sign * g * times * slip, "slope": sign * by_slope, "speed": slip * ratio}

    def coulomb(values: Values) -> tuple[Array, dict[str, Array]]:
        sign, v = copysign(1.0, values["speed"]), abs(values["speed"]) - values["mu"] * g * times
        return sign * v.clip(0.0), {"mu": -sign * g * times * (v > 0.0), "speed": np.where(v > 0.0, 1.0, 0.0)}

    if slider.law == "coulomb":
        return Model(known(slider, "mu", "speed"), coulomb, times, LABELS)
    return Model(known(slider, "mu", "slope", "speed"), tanh, times, LABELS)


def breakaway(slider: Slider, times: Array, force_rate: float) -> Model:
    """Speed of a slider at rest under the force r t, `force_rate` in N/s, by Coulomb's law."""
    g, rate = slider.normal_force / slider.mass, force_rate / slider.mass

    def predict(values: Values) -> tuple[Array, dict[str, Array]]:
        start = values["mu_static"] * g / rate
        slides, acceleration = (times - start).clip(0.0), rate * start - values["mu"] * g
        by_static = np.where(slides > 0.0, -acceleration * g / rate, 0.0)
        return slides * (0.5 * rate * slides + acceleration), {"mu": -g * slides, "mu_static": by_static}

    return Model(known(slider, "mu", "mu_static"), predict, times, LABELS)


def run(slider: Slider, names: Sequence[str], times: Array, simulated: Callable[[Slider, float], Any]) -> Model:
    """Speed of a slider on the driven beam; `simulated` returns its motion until a time, s.

    A slider without mu_static has it where it is in `names`. Derivatives are central differences: analytic ones would
    have to pass through the whole contact engine.
    """

    def predict(values: Values) -> tuple[Array, None]:
        if "mu_static" in values:
            values["mu_static"] = max(values["mu_static"], values["mu"])
        motion = simulated(replace(slider, **values), float(times.max()))
        if motion.times[-1] < times.max() * (1.0 - 1e-9):
            raise InputError(f"the slider leaves the beam after {motion.times[-1]:g} s: give shorter data")
        return np.interp(times, motion.times, motion.speed), None

    static = slider.mu_static is not None or "mu_static" in names  # otherwise mu alone is both
    own = ("slope",) if slider.law != "coulomb" else ("mu_static",) if static else ()
    return Model(known(slider, "mu", *own), predict, times, LABELS)
