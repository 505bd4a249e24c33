"""Friction of a slider from its speed over time: free decay, breakaway under a growing force, a run on the beam.

On a surface at rest, with g = N/m (the normal force over the mass; gravity without preload):

- Eq. (3), m dv/dt = -mu N tanh(K v): sinh(K v) = sinh(K v0) e^{-mu g K t};
- Coulomb's law: |v| = max(|v0| - mu g t, 0), a constant deceleration;
- Coulomb's law under a force r t: rest until r t = mu_s N, then v = r (t^2 - t_b^2)/(2m) - mu g (t - t_b), t_b = mu_s N/r.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array
from verify.errors import InputError
from verify.identify.fit import Model, Parameter, Values
from verify.problem.slider import Slider

TIME, SPEED = ("time", "s"), ("speed", "m/s")
STEEP = (1e-3, 1e7)
"""Bounds of K, s/m."""


def parameters(slider: Slider, *names: str) -> dict[str, Parameter]:
    """Parameters of a slider, of `mu`, `mu_static`, `slope` (K, s/m) and `speed` (initial). Raises InputError."""
    static = slider.mu if slider.mu_static is None else slider.mu_static
    values = {"mu": slider.mu, "mu_static": static, "slope": slider.steepness or 0.0, "speed": slider.speed}
    bounds = {"mu": (1e-6, 10.0), "mu_static": (1e-6, 10.0), "slope": STEEP, "speed": (-np.inf, np.inf)}
    units = {"slope": "s/m", "speed": "m/s"}
    for name in names:
        if not bounds[name][0] <= values[name] <= bounds[name][1]:
            raise InputError(f"slider.{name} = {values[name]!r} cannot start a fit: give another")
    return {name: Parameter(values[name], units.get(name, ""), *bounds[name]) for name in names}


def decay(slider: Slider, times: Array) -> Model:
    """Speed of a slider that slides freely on a beam at rest, (n,), by its friction law. Raises InputError at rest."""
    g, coulomb = slider.normal_force / slider.mass, slider.law == "coulomb"
    if slider.speed == 0.0:
        raise InputError("slider.speed = 0.0: a free decay needs an initial speed, give it in m/s")

    def tanh(values: Values) -> tuple[Array, dict[str, Array]]:
        mu, slope, sign = values["mu"], values["slope"], np.sign(values["speed"])
        start = max(abs(values["speed"]), 1e-12)
        steep = slope * start  # ln sinh(K v), by logarithms: K v0 may be 1e3 and more
        log = steep + np.log1p(-np.exp(-2.0 * steep)) - np.log(2.0) - mu * g * slope * times
        v = np.where(log > 0.0, log + np.log1p(np.sqrt(1.0 + np.exp(-2.0 * abs(log)))), np.arcsinh(np.exp(-abs(log))))
        v = v / slope
        slip, ratio = np.tanh(slope * v), 1.0 / np.tanh(steep)
        by_slope = -v / slope + slip * (start * ratio - mu * g * times) / slope
        return sign * v, {"mu": -sign * g * times * slip, "slope": sign * by_slope, "speed": slip * ratio}

    def constant(values: Values) -> tuple[Array, dict[str, Array]]:
        sign = np.sign(values["speed"])
        v = abs(values["speed"]) - values["mu"] * g * times
        slides = v > 0.0
        return sign * np.where(slides, v, 0.0), {"mu": -sign * g * times * slides, "speed": 1.0 * slides}

    known = parameters(slider, "mu", *(() if coulomb else ("slope",)), "speed")
    return Model(known, constant if coulomb else tanh, times, (TIME, SPEED))


def breakaway(slider: Slider, times: Array, force_rate: float) -> Model:
    """Speed of a slider at rest under the force r t, `force_rate` in N/s, by Coulomb's law."""
    normal, rate = slider.normal_force, force_rate / slider.mass

    def predict(values: Values) -> tuple[Array, dict[str, Array]]:
        mu, g, begins = values["mu"], normal / slider.mass, values["mu_static"] * normal / force_rate
        after = np.maximum(times - begins, 0.0)
        acceleration = rate * begins - mu * g
        v = 0.5 * rate * after**2 + acceleration * after
        return v, {"mu": -g * after, "mu_static": -acceleration * (after > 0.0) * normal / force_rate}

    return Model(parameters(slider, "mu", "mu_static"), predict, times, (TIME, SPEED))


def run(slider: Slider, times: Array, simulated: Callable[[Slider, float], Any]) -> Model:
    """Speed of a slider on the driven beam, (n,); `simulated` returns its motion until a time, s.

    The derivatives are central differences: analytic ones would have to pass through the whole contact engine.
    """
    names = ("mu", "mu_static") if slider.law == "coulomb" else ("mu", "slope")

    def predict(values: Values) -> tuple[Array, None]:
        static = {"mu_static": max(values["mu_static"], values["mu"])} if "mu_static" in values else {}
        motion = simulated(replace(slider, **values | static), float(times.max()))
        if motion.times[-1] < times.max() * (1.0 - 1e-9):
            raise InputError(f"the slider leaves the beam after {motion.times[-1]:g} s: give shorter data")
        return np.interp(times, motion.times, motion.speed), None

    return Model(parameters(slider, *names), predict, times, (TIME, SPEED))
