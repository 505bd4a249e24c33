"""Fits of lists that are made up: members of the family, a list with them, a fit with what is asked of it."""

from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam
from verify.models.arrays import Array
from verify.stress.references.beams import held

FREE = held("clamped", "free")
"""The beam of which the lists are."""


def family_of(count: int | None) -> dict[str, Any]:
    """Those that a clamp that gives is looked for beside; of known size other walls and the thick ones as well."""
    from verify.identify.family import Candidate

    walls = ("half", "gregory", "third-order", "five-joint") if count else ("half",)
    found = {wall: Candidate(model="segment", wall=wall, joints="series", mass="links") for wall in walls}
    found |= {"consistent": Candidate(model="fem", mass="consistent"), "analytic": Candidate(model="analytic")}
    others = [replace(one, theory="rayleigh") for one in found.values()] if count else []
    return found | {f"thick {one.wall or one.model}": one for one in others}


def data_of(beam: Beam, listed: Array, family: tuple[Any, ...], rounding: float = 0.0, more: int = 0) -> Any:
    """A list of a beam in Hz, rounded by a share, members to compare it with, and a solver of so many modes `more`."""
    from verify.identify.family import Solver
    from verify.identify.fitting import Data

    n = len(listed)
    return Data(listed=listed, rounding=np.full(n, rounding), family=family, solver=Solver(beam, n + more))


def fit_of(**given: Any) -> Any:
    """A fit with what is asked of it."""
    from verify.identify.alignment import in_order_of
    from verify.identify.fitting import Fit

    plain = {
        "candidate": family_of(None)["half"],
        "count": 9,
        "pairs": in_order_of(5),
        "factor": 1.0,
        "differences": np.zeros(5),
        "residual": 0.0,
        "score": 0.0,
    }
    return Fit(**{**plain, **given})


def clamp_giving(stiffness: float) -> Any:
    """The clamp of `FREE` that gives, of k_r L / EI."""
    from verify.identify.clamps import clamp_of

    return clamp_of(FREE, ("left",), 1.0 / stiffness)


def told_of(best: Any, alike: tuple[Any, ...] = (), **given: Any) -> Any:
    """What is told of a list whose best fit this is, in its own unit and with nothing systematic unless given."""
    from verify.identify.fitting import PLAIN, Identified

    return Identified(fits=(best, *alike), alike=alike, **{"reading": PLAIN, "systematic": False, **given})
