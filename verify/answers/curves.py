"""The joints of a rod along a curve as a chain of rigid bodies."""

from collections.abc import Sequence
from dataclasses import replace
from math import inf
from pathlib import Path

import numpy as np

from verify.answers.chains import chain_result, steps_of
from verify.blas import one_blas_thread
from verify.engines.choice import default_steps
from verify.engines.curved import curved_chain
from verify.engines.damping import asked, damped
from verify.engines.description import MOST_LINKS, RigidChain
from verify.engines.rod import read_rod
from verify.engines.writers import write
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
    default links run from point to point. Else as of `engine_chain`; errors are against the rod as finer links estimate
    it. Raises InputError.
    """
    check_integer("mode", mode, 1, 100)
    check_number("error", error, "relative, of a frequency", at_least=1e-12, below=1)
    rod, request, own = read_rod(Path(curve), overrides, section, in_space), asked(damping), str(path or "").lower()
    points = np.unique(rod.s)
    number = len(points) - 1 if count is None else count
    check_integer("count", number, 2, MOST_LINKS // (1 + 3 * rod.in_space))  # matrices are dense
    chain: RigidChain = curved_chain(rod, points if count is None else np.linspace(0.0, points[-1], number + 1))
    engine = engine or "MuJoCo" * own.endswith((".xml", ".mjcf"))
    steps = steps_of(engine, inf, bool(request.ratios[0]))[0] if engine else None
    chain = damped(chain, request, steps)
    chain = default_steps(chain, steps, mode, error) if steps else chain
    result = chain_result(chain, mode, error)
    return result if path is None else replace(result, data=dict(result.data) | {"wrote": write(chain, Path(path))})
