"""Named quantities of interest for gates, claims, tables and `verify measure`: one module a family."""

from verify.quantities import (  # noqa: F401
    actuator,
    cases,
    chain,
    control,
    drive,
    identify,
    modes,
    motor,
    shunt,
    slider,
    study,
    waves,
)
from verify.quantities.base import QUANTITIES, describe, evaluate, parse_arguments, quantity

__all__ = ["QUANTITIES", "describe", "evaluate", "parse_arguments", "quantity"]
