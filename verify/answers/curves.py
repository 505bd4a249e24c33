"""The joints of a rod along a curve as a chain of rigid bodies."""

from collections.abc import Sequence
from dataclasses import replace
from math import inf, pi
from pathlib import Path
from typing import Any

import numpy as np

from verify.answers.chains import chain_result, steps_of
from verify.blas import one_blas_thread
from verify.engines.choice import default_steps
from verify.engines.curved import curved_chain
from verify.engines.damping import asked
from verify.engines.description import MOST_LINKS, with_dashpots
from verify.engines.rod import read_rod
from verify.engines.writers import write
from verify.errors import InputError
from verify.report.result import Result
from verify.validation import check_integer, check_number


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
    engine: str = "",
    path: str | Path | None = None,
) -> Result:
    """Joints and links of a rod along a curve, clamped at its first point and free at its last.

    `curve`, `section`, `overrides`, `in_space`: as of `engines.rod.read_rod`. `count`: links of one arc length; by
    default links run from point to point. `damping`: ratio of one mode. Else as of `engine_chain`; errors are against
    the rod as finer links estimate it. Raises InputError.
    """
    check_integer("mode", mode, 1, 100)
    check_number("error", error, "relative, of a frequency", at_least=1e-12, below=1)
    rod, request, own = read_rod(Path(curve), overrides, section, in_space), asked(damping), str(path or "").lower()
    points = np.unique(rod.s)
    number = len(points) - 1 if count is None else count
    check_integer("count", number, 2, MOST_LINKS // (1 + 3 * rod.in_space))  # matrices are dense
    chain: Any = curved_chain(rod, points if count is None else np.linspace(0.0, points[-1], number + 1))
    ratio = request.ratios[0]
    if len(request.ratios) > 1 or request.in_hz or request.compensated:
        raise InputError(f"damping = {damping!r}: a curved chain has that of one mode, give '1%' or '1% at 2'")
    if ratio:
        omega = (2.0 * pi * chain.frequencies_hz(n_modes=int(request.at[0]))).tolist()
        chain = with_dashpots(chain, dict.fromkeys(chain.axes, 2.0 * ratio / omega[-1]), ratio * omega[0] / omega[-1])
    engine = engine or "MuJoCo" * own.endswith((".xml", ".mjcf"))
    if engine:
        chain = default_steps(chain, steps_of(engine, inf, bool(ratio))[0], mode, error)
    result = chain_result(chain, mode, error)
    return result if path is None else replace(result, data=dict(result.data) | {"wrote": write(chain, Path(path))})
