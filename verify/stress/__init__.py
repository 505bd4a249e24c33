"""Numerical stress checks: errors and costs along one parameter, up to where they exceed their tolerance."""

from verify.stress.engine import Check, Outcome, run, select

__all__ = ["Check", "Outcome", "run", "select"]
