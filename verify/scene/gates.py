"""Gates evaluated: value, band, verdict, and the fraction of the tolerance that is used."""

from math import hypot, isfinite
from time import perf_counter
from typing import Any

import msgspec

from verify.analysis.solution_cache import Bracket, SolutionCache
from verify.errors import InputError
from verify.quantities.base import QUANTITIES, evaluate
from verify.scene.model import Complex, Gate, Scene


class GateResult(msgspec.Struct, frozen=True, kw_only=True):
    """One gate's verdict: the row of a terminal or a page, and the outcome of a pytest item."""

    gate: Gate
    value: Any = None
    """A float, a complex number or a `Bracket`; None where the gate was skipped or could not be evaluated."""
    unit: str = ""
    passed: bool | None = None  # None where the gate was skipped
    fraction: float | None = None
    """Fraction of the tolerance: 0 in the middle of the band, 1 at its edge; None where the band has no width."""
    reason: str = ""  # why it failed or was skipped
    seconds: float = 0.0

    @property
    def id(self) -> str:
        """Id of the gate."""
        return self.gate.id


def run_gate(gate: Gate, scene: Scene, cache: SolutionCache) -> GateResult:
    """Evaluate one gate. Never raises: a gate that cannot be evaluated fails with the reason."""
    start = perf_counter()
    unit, value, fraction = "", None, None
    try:
        unit = QUANTITIES.named(gate.quantity).unit_of(gate.arguments)
        value = evaluate(gate.quantity, gate.arguments, scene, cache)
        reason, fraction = _verdict(gate, value)
    except InputError as error:
        reason = f"cannot be evaluated: {error}"
    except Exception as error:  # a defect of this package, or of another one's quantity
        reason = f"cannot be evaluated: {type(error).__name__}: {error}"
    seconds = perf_counter() - start
    return GateResult(
        gate=gate, value=value, unit=unit, passed=not reason, fraction=fraction, reason=reason, seconds=seconds
    )


def _verdict(gate: Gate, value: Any) -> tuple[str, float | None]:
    """(reason for failing or '', fraction of the tolerance)."""
    kinds = {Bracket: "a bracket needs expect alone", complex: "a complex value needs expect = { re, im } with within"}
    remedy = kinds.get(type(value), "a real value needs expect with within, or at_least, at_most")
    outside, fraction = f"{value!r}: {remedy}", None
    if isinstance(value, Bracket) and isinstance(gate.expect, float) and gate.within is None:
        fraction = _fraction(gate.expect, value.lower, value.upper)
        inside = value.lower < gate.expect < value.upper
        outside = "" if inside else f"{value.lower!r} to {value.upper!r} does not contain {gate.expect!r}"
    elif isinstance(value, complex) and isinstance(gate.expect, Complex) and gate.within is not None:
        fraction = hypot(value.real - gate.expect.re, value.imag - gate.expect.im) / gate.within
        outside = "" if fraction <= 1.0 else f"{value!r} lies outside the disc"
    elif isinstance(value, float | int) and not isfinite(value):
        outside = f"{value!r} is not finite"
    elif isinstance(value, float | int) and isinstance(gate.expect, float) == (gate.within is not None):
        low, high = gate.bounds
        if isinstance(gate.expect, float) and gate.within is not None:
            low, high = gate.expect - gate.within, gate.expect + gate.within
        fraction = _fraction(value, low, high)
        side = f"below {low!r}" if value < low else f"above {high!r}"
        outside = "" if low <= value <= high else f"{value!r} lies {side}"
    return outside, fraction


def _fraction(value: float, low: float, high: float) -> float | None:
    """Distance from the band's middle over half its width; of a one-sided band the ratio to its limit."""
    if isfinite(low) and isfinite(high):
        half = 0.5 * (high - low)
        return abs(value - 0.5 * (low + high)) / half if half > 0 else None
    if isfinite(high) and high > 0:
        return max(value, 0.0) / high
    return low / value if isfinite(low) and low > 0 and value > 0 else None
