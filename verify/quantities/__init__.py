"""Named quantities of interest for gates, claims, tables and `verify measure`: one module a family."""

from verify.quantities import modes, waves
from verify.quantities.base import QUANTITIES, describe, evaluate, parse_arguments, quantity

__all__ = ["QUANTITIES", "describe", "evaluate", "modes", "parse_arguments", "quantity", "waves"]
