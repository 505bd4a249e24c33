"""How many parts, how many modes."""

from collections.abc import Callable
from decimal import Decimal, localcontext
from math import pi

import numpy as np

from verify.beam import Beam
from verify.models.catalogue import MODELS
from verify.stress.beams import STRIP, held
from verify.stress.kind import Figure, Floor, Refusal, Row

FIRST = 5
"""Modes of a size that are looked at."""
PARTS = {"segment": "segments", "fem": "elements"}


def dispersion_error(model: str) -> Figure:
    """N -> worst relative error of the first modes against the discrete dispersion in closed form."""

    def error(n: float) -> float:
        from verify.exact.error_laws import dispersion_frequency_hz

        found = MODELS[model].solve_modes(STRIP, FIRST, int(n)).frequencies_hz
        exact = [dispersion_frequency_hz(model, STRIP, mode, int(n)) for mode in range(1, FIRST + 1)]
        return float(abs(found / np.array(exact) - 1.0).max())

    return error


def assembled_error(model: str) -> Figure:
    """The same by eigsh on assembled matrices."""

    def error(n: float) -> float:
        from verify.exact.error_laws import dispersion_frequency_hz
        from verify.stress.textbook import assembled_roots, hertz

        roots = assembled_roots(model, STRIP.supports, int(n), FIRST)
        exact = [dispersion_frequency_hz(model, STRIP, mode, int(n)) for mode in range(1, FIRST + 1)]
        found = [hertz(STRIP, root, STRIP.length / n) for root in roots]
        return float(abs(np.array(found) / np.array(exact) - 1.0).max())

    return error
