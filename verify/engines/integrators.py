"""Integrators of multibody engines and their schemes.

What an engine does was measured in the version of its row, with springs and dashpots of joints, without equalities and
contacts.
"""

from typing import NamedTuple

from verify.errors import InputError, shown
from verify.linear.step_schemes import (
    CENTRAL,
    EXPLICIT_DASHPOTS,
    EXPLICIT_EULER,
    IMPLICIT_DASHPOTS,
    IMPLICIT_EULER,
    RADAU3,
    RK2,
    RK3,
    RK4,
    TRAPEZOIDAL,
    TWO_HALVES,
    Scheme,
    generalised_alpha,
    newmark,
)
from verify.validation import check_choice


class Integrator(NamedTuple):
    """A setting of an engine, its scheme (None: no one-step map in N m/rad), the version measured, and remarks."""

    engine: str
    setting: str
    scheme: Scheme | None
    version: str
    remark: str = ""


INTEGRATORS = (
    Integrator("MuJoCo", "Euler", IMPLICIT_DASHPOTS, "4.0.0"),
    Integrator("MuJoCo", "implicit", IMPLICIT_DASHPOTS, "4.0.0"),
    Integrator("MuJoCo", "implicitfast", IMPLICIT_DASHPOTS, "4.0.0", "its springs are explicit: the limit is Euler's"),
    Integrator("MuJoCo", "Euler without eulerdamp", EXPLICIT_DASHPOTS, "4.0.0"),
    Integrator("MuJoCo", "RK4", RK4, "4.0.0"),
    Integrator("MuJoCo", "discrete", IMPLICIT_EULER, "4.0.0"),
    Integrator("Drake", "SAP", IMPLICIT_DASHPOTS, "1.51.1", "of a discrete plant; also Lagged and Similar"),
    Integrator("Drake", "TAMSI", EXPLICIT_DASHPOTS, "1.51.1", "of a discrete plant without contact"),
    Integrator("Drake", "SAP, PD gains", IMPLICIT_EULER, "1.51.1", "springs and dashpots are gains of an actuator"),
    Integrator("Drake", "runge_kutta2", RK2, "1.51.1", "fixed step"),
    Integrator("Drake", "runge_kutta3", RK3, "1.51.1", "fixed step; the default controls its error"),
    Integrator("Drake", "explicit_euler", EXPLICIT_EULER, "1.51.1", "fixed step"),
    Integrator("Drake", "semi_explicit_euler", EXPLICIT_DASHPOTS, "1.51.1", "fixed step"),
    Integrator("Drake", "radau1", IMPLICIT_EULER, "1.51.1", "fixed step"),
    Integrator("Drake", "radau3", RADAU3, "1.51.1", "fixed step"),
    Integrator("Drake", "implicit_euler", TWO_HALVES, "1.51.1", "fixed step; also velocity_implicit_euler"),
    Integrator("DART", "default", IMPLICIT_EULER, "6.20.0"),
    Integrator("Gazebo", "DART", IMPLICIT_EULER, "", "from DART, not run in Gazebo"),
    Integrator("Newton", "Featherstone", EXPLICIT_DASHPOTS, "1.8.0", "single precision"),
    Integrator("Newton", "MuJoCo implicitfast", IMPLICIT_DASHPOTS, "1.8.0", "single precision"),
    Integrator("Newton", "MuJoCo Euler", IMPLICIT_DASHPOTS, "1.8.0", "passive damping of joints"),
    Integrator("Newton", "MuJoCo Euler, target_kd", EXPLICIT_DASHPOTS, "1.8.0"),
    Integrator("Newton", "VBD", IMPLICIT_EULER, "1.8.0", "target gains, within 0.2 % from 100 iterations on"),
    Integrator("Newton", "XPBD", None, "1.8.0", "its frequencies depend on the number of iterations"),
    Integrator("Newton", "SemiImplicit", None, "1.8.0", "its joints are penalties with modes of their own"),
    Integrator("Bullet", "user torque", EXPLICIT_DASHPOTS, "3.2.7", "set body damping, 0.04 1/s by default, to 0"),
    Integrator("Bullet", "POSITION_CONTROL", None, "3.2.7", "it is a constraint on velocity"),
    Integrator("Exudyn", "GeneralizedAlpha", generalised_alpha(0.9), "1.13.6", "default, spectral radius 0.9"),
    Integrator("Exudyn", "GeneralizedAlpha 0.5", generalised_alpha(0.5), "1.13.6"),
    Integrator("Exudyn", "Newmark", newmark(0.25), "1.13.6"),
    Integrator("Exudyn", "TrapezoidalIndex2", TRAPEZOIDAL, "1.13.6"),
    Integrator("Exudyn", "ExplicitEuler", EXPLICIT_EULER, "1.13.6"),
    Integrator("Exudyn", "ExplicitMidpoint", RK2, "1.13.6"),
    Integrator("Exudyn", "RK33", RK3, "1.13.6"),
    Integrator("Exudyn", "RK44", RK4, "1.13.6"),
    Integrator("Exudyn", "VelocityVerlet", EXPLICIT_DASHPOTS, "1.13.6"),
    Integrator("PyElastica", "PositionVerlet", CENTRAL, "1.0.0"),
)
"""The first setting of an engine is its default."""


def integrator_of(engine: str, setting: str = "") -> Integrator:
    """The row of an engine, by default its first one; capitals do not matter. Raises InputError."""
    rows = [row for row in INTEGRATORS if row.engine.casefold() == str(engine).casefold()]
    if not rows:
        check_choice("engine", engine, tuple(dict.fromkeys(row.engine for row in INTEGRATORS)))
    named = {row.setting.casefold(): row for row in rows}
    if (name := setting or rows[0].setting).casefold() not in named:
        check_choice("integrator", setting, [row.setting for row in rows])
    return named[name.casefold()]


def scheme_of(engine: str, setting: str = "") -> Scheme:
    """The scheme of a row of `integrator_of`. Raises InputError."""
    if (scheme := (row := integrator_of(engine, setting)).scheme) is None:
        text = f"has no springs in N m/rad: {row.remark}, choose another of {engine}"
        raise InputError(f"integrator = {shown(setting)} {text}")
    return scheme
