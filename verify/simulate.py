"""A linear beam in time, with a slider on it or without. The room is `verify.motion`."""

from verify.motion.result import Motion
from verify.motion.simulate import simulate

__all__ = ["Motion", "simulate"]
