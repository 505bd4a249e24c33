"""Exact values of the sheets of friction from the numbers of their own parameters."""

import tomllib
from math import atan, atan2, cos, exp, hypot, pi, radians, sin, sqrt
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

DATA = Path(__file__).parents[2] / "verify" / "sheets" / "data"


def ramp(p):
    pull, friction = (
        p.gravity_m_per_s2 * sin(radians(p.angle_deg)),
        p.friction_coefficient * p.gravity_m_per_s2 * cos(radians(p.angle_deg)),
    )
    return 0.5 * p.speed_m_per_s**2 / (pull + friction), friction - pull, 0.0


def decay(p):
    stretch = p.friction_coefficient * p.mass_kg * p.gravity_m_per_s2 / p.stiffness_n_per_m
    turns = [(-1) ** n * (p.start_m - 2 * n * stretch) for n in range(6)]
    assert abs(turns[5]) < stretch < abs(turns[4])  # it sticks at the fifth turn
    return turns[1], turns[2], turns[4], turns[5]


def belt(p):
    rate = sqrt(p.stiffness_n_per_m / p.mass_kg)
    stretch = p.friction_coefficient * p.mass_kg * p.gravity_m_per_s2 / p.stiffness_n_per_m
    return stretch, p.belt_speed_m_per_s / rate, rate / (2 * pi), 0.0


def stick_slip(p):
    rate, speed = sqrt(p.stiffness_n_per_m / p.mass_kg), p.belt_speed_m_per_s
    static, kinetic = (
        mu * p.mass_kg * p.gravity_m_per_s2 / p.stiffness_n_per_m
        for mu in (p.static_friction_coefficient, p.kinetic_friction_coefficient)
    )
    lead = static - kinetic
    amplitude = hypot(lead, speed / rate)
    return 2 * lead / speed + 2 / rate * (pi - atan(lead * rate / speed)), kinetic + amplitude, amplitude


def restitution(p):
    for damping in (p.damping_a_n_s_per_m, p.damping_b_n_s_per_m, p.damping_c_n_s_per_m):
        zeta = damping / (2 * sqrt(p.stiffness_n_per_m * p.mass_kg))
        side = sqrt(1 - zeta**2)
        yield p.speed_m_per_s * exp(-2 * zeta * atan2(side, zeta) / side)
    run = solve_ivp(  # ball a: (overlap, its rate) until the force ends
        lambda t, y: (y[1], -(p.stiffness_n_per_m * y[0] + p.damping_a_n_s_per_m * y[1]) / p.mass_kg),
        (0.0, 1.0),
        (0.0, p.speed_m_per_s),
        events=released(p),
        rtol=1e-12,
        atol=1e-15,
    )
    (overlap, rate), end = run.y_events[0][0], run.t_events[0][0]
    flight = p.duration_s - p.gap_m / p.speed_m_per_s - end
    yield (-p.gap_m - overlap - rate * flight) / p.duration_s


def released(p):
    def force(t, y):
        return p.stiffness_n_per_m * y[0] + p.damping_a_n_s_per_m * y[1]

    force.terminal, force.direction = True, -1.0
    return force


def slider(p):
    """By direct sums over the phases of a wave at which a spring of the layer stands."""
    k, omega, cosine = 2 * pi / p.wavelength_m, 2 * pi * p.frequency_hz, np.cos(2 * pi * (np.arange(1e5) + 0.5) / 1e5)

    def pressure(z):
        return p.layer_stiffness_n_per_m2 * np.maximum(p.amplitude_m * cosine - z, 0.0)

    height = brentq(
        lambda z: p.wavelength_m * pressure(z).mean() - p.mass_kg * p.gravity_m_per_s2, -p.amplitude_m, p.amplitude_m
    )
    crest = p.lever_m * k * omega * p.amplitude_m
    return -brentq(lambda v: pressure(height) @ np.sign(crest * cosine - v), 0.0, crest), height


SHEETS = {
    "ramp-stick": lambda p: (0.0,),
    "ramp-slip": ramp,
    "decay": decay,
    "belt": belt,
    "belt-stick-slip": stick_slip,
    "capstan": lambda p: (p.hold_n * exp(p.friction_coefficient * p.wrap_rad), p.hold_n),
    "restitution": restitution,
    "slider-on-wave": slider,
    "swinging-chain": lambda p: (0.5 * p.mass_kg * p.gravity_m_per_s2 * p.length_m * p.rods**2, 0.0),
    "damped-sag": lambda p: (
        2 * (1.5 * p.density_kg_per_m3 * p.gravity_m_per_s2 * p.length_m**4 / (p.youngs_modulus_Pa * p.thickness_m**2),)
    ),
}


@pytest.mark.parametrize("name", SHEETS)
def test_a_sheet_of_friction_has_the_exact_values_of_its_parameters(name):
    sheet = tomllib.loads((DATA / name / "sheet.toml").read_text())
    expected = list(SHEETS[name](SimpleNamespace(**sheet["parameters"])))
    for figure, value in zip(sheet["figure"], expected, strict=True):
        assert figure["exact"] == pytest.approx(value, abs=max(figure.get("uncertainty", 0.0), 1e-9 * abs(value))), (
            figure["name"]
        )
        for cause in figure.get("cause", ()):  # none of a value that passes
            assert abs(cause["value"] - value) > cause["within"] * abs(cause["value"]), figure["name"]


@pytest.mark.parametrize(
    "name",
    ["belt", "belt-stick-slip", "capstan", "decay", "ramp-slip", "restitution", "slider-on-wave", "swinging-chain"],
)
def test_powers_of_parameters_are_those_of_the_closed_forms(name):
    sheet = tomllib.loads((DATA / name / "sheet.toml").read_text())
    for parameter in {one for figure in sheet["figure"] for one in figure.get("powers", ())} - {"damping"}:
        low, high = (
            list(
                SHEETS[name](
                    SimpleNamespace(**sheet["parameters"] | {parameter: factor * sheet["parameters"][parameter]})
                )
            )
            for factor in (0.999, 1.001)
        )
        for figure, a, b in zip(sheet["figure"], low, high, strict=True):
            if "powers" in figure:
                power = figure["powers"].get(parameter, 0.0)
                assert power == pytest.approx(np.log(b / a) / np.log(1.001 / 0.999), abs=6e-3), (
                    parameter,
                    figure["name"],
                )
