"""All cases by name."""

from verify.cases import (  # noqa: F401  # each adds its cases
    belt,
    coulomb_decrement,
    creep,
    elastica,
    energy,
    foot_on_wave,
    hanging_chain,
    landing,
    large_amplitude,
    moving_load,
    restitution,
    roll_up,
    rotating_cantilever,
    slider_on_wave,
)
from verify.cases.base import CASES

__all__ = ["CASES"]
