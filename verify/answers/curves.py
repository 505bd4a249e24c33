"""The joints of a rod along a curve as a chain of rigid bodies."""

from collections.abc import Sequence
from math import ceil
from pathlib import Path
from typing import Any

import numpy as np

from verify.answers.chains import made_chain
from verify.blas import one_blas_thread
from verify.engines.curved import CurvedChain, curved_chain
from verify.engines.description import MOST_LINKS
from verify.engines.rod import read_rod
from verify.errors import InputError
from verify.report.result import Result
from verify.validation import check_integer, check_type


@one_blas_thread()
def curve_chain(
    curve: str | Path,
    count: int | None = None,
    *,
    mode: int = 3,
    error: float = 0.01,
    section: str = "",
    overrides: Sequence[str] = (),
    in_space: bool = False,
    damping: float | str = 0.0,
    step: float | None = None,
    engine: str = "",
    path: str | Path | None = None,
) -> Result:
    """Joints and links of a rod along a curve, clamped at its first point and free at its last.

    `curve`, `section`, `overrides`, `in_space`: as of `engines.rod.read_rod`. `count`: links of one arc length; by
    default links run from point to point, and for a `step` they are the fewest that run. Else as of `engine_chain`;
    errors are against the rod as finer links estimate it. Raises InputError.
    """
    check_type("curve", curve, str, Path)
    rod = read_rod(Path(curve), overrides, section, in_space)
    points, most = np.unique(rod.s), MOST_LINKS // (1 + 3 * rod.in_space)  # matrices are dense

    def divided(number: int) -> CurvedChain:
        check_integer("count", number, 2, most)
        return curved_chain(rod, np.linspace(0.0, points[-1], number + 1))

    wanted: dict[str, Any] = {"mode": mode, "error": error, "damping": damping, "step": step, "engine": engine}
    if count is not None or step is not None:
        return made_chain(divided, ceil(rod.turning), count, path=path, **wanted)
    if not 2 < len(points) <= most + 1:
        raise InputError(f"curve: links from point to point are {len(points) - 1}, of 2 to {most}, give count")
    return made_chain(lambda _: curved_chain(rod, points), 2, len(points) - 1, path=path, **wanted)
