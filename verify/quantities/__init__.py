"""Named quantities of interest for gates, claims, tables and `verify measure`: one module a family."""

from verify.quantities.base import QUANTITIES, describe, evaluate, parse_arguments, quantity

__all__ = ["QUANTITIES", "describe", "evaluate", "parse_arguments", "quantity"]
