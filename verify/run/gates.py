"""Gates judged: expected, measured, band, reason."""

from math import hypot, isfinite
from time import perf_counter
from typing import TYPE_CHECKING, Any

import msgspec

from verify.errors import InputError
from verify.judge.bracket import Bracket
from verify.options import Reference
from verify.quantities.catalogue import QUANTITIES, arguments_of, as_plain, evaluate, in_words, needs_of, quantity
from verify.quantities.kind import Figure, Quantity
from verify.scenes.scene import Complex
from verify.words import rounded

if TYPE_CHECKING:
    from verify.judge.workbench import Workbench
    from verify.scenes.scene import Gate, Scene


NOT_SAID = "not said"
"""Of the reference of a gate whose scene does not name it."""


class Band(msgspec.Struct, frozen=True, kw_only=True):
    """What a gate allows, as it was given: `expect` with `within`, `at_least`, `at_most`; None where not given."""

    expect: float | Complex | None
    within: float | None
    at_least: float | None
    at_most: float | None


class GateResult(msgspec.Struct, frozen=True, kw_only=True):
    """One gate's verdict: the same object is a test item, a row in the terminal and a row of the report."""

    id: str
    quantity: str
    arguments: dict[str, Any]
    why: str
    unit: str
    expected: str
    """The expectation in words: '-0.00428024 ± 5e-09', 'at most 0.01', 'contains 4469.94'."""
    band: Band
    """The same in numbers."""
    measured: Any
    """A number or {"lower", "upper"}; None where the gate could not be evaluated, or was not."""
    passed: bool | None
    """None where it does not apply."""
    applicable: bool
    """Whether it was stated for what the scene was run with."""
    share: float | None
    """Share of the band used: 0 in its middle, 1 at its edge; None where the band has no width."""
    reason: str
    """Why it failed or does not apply; empty where it passed."""
    seconds: float
    reference: Reference | None = None
    """What stands behind the expectation; None where the scene does not say."""
    uncertainty: float | None = None
    """The reference's own, in the gate's unit; None where the scene does not say."""
    source: str = ""
    """Where the reference is to be found; empty where the scene does not say."""


def judge(gate: "Gate", scene: "Scene", bench: "Workbench") -> GateResult:
    """Evaluate one gate. Never raises on a wrong gate or a failing model: a gate that cannot be evaluated fails."""
    start = perf_counter()
    unit, reason = "", ""
    value: Figure | None = None
    try:
        found = quantity(gate.quantity)
        unit, value = found.unit, _evaluated(found, gate, scene, bench)
    except InputError as error:
        reason = f"cannot be evaluated: {error}"
    except Exception:  # a fault of the suite's own, not of the input: every such place is to become an InputError
        reason = f"cannot be evaluated: the suite itself fails on it, `verify measure {gate.quantity}` shows where"
    share = None
    if value is not None:
        reason, share = _verdict(gate, value)
    return GateResult(
        id=gate.id,
        quantity=gate.quantity,
        arguments=gate.arguments,
        why=gate.why,
        unit=unit,
        expected=expectation(gate),
        band=given_band(gate),
        measured=as_plain(value),
        passed=not reason,
        applicable=True,
        share=share,
        reason=reason,
        seconds=perf_counter() - start,
        reference=gate.reference,
        uncertainty=gate.uncertainty,
        source=gate.source,
    )


def set_aside(gate: "Gate", reason: str) -> GateResult:
    """The result of a gate that does not apply: neither passed nor failed, and nothing is evaluated for it."""
    known = gate.quantity in QUANTITIES
    return GateResult(
        id=gate.id,
        quantity=gate.quantity,
        arguments=gate.arguments,
        why=gate.why,
        unit=quantity(gate.quantity).unit if known else "",
        expected=expectation(gate),
        band=given_band(gate),
        measured=None,
        passed=None,
        applicable=False,
        share=None,
        reason=reason,
        seconds=0.0,
        reference=gate.reference,
        uncertainty=gate.uncertainty,
        source=gate.source,
    )


def reference_in_words(gate: "Gate | GateResult", unit: str = "") -> str:
    """What stands behind a gate: 'closed form ± 3e-05 Hz, (n pi/L)^2 ...'; 'not said' where its scene does not say.

    The unit is the result's own where there is one.
    """
    if gate.reference is None:
        return NOT_SAID
    unit = gate.unit if isinstance(gate, GateResult) else unit
    size = f" ± {gate.uncertainty:g}{f' {unit}' if unit not in ('', '1') else ''}" if gate.uncertainty else ""
    exact = ", exact" if gate.uncertainty == 0 else ""
    return f"{gate.reference}{size}{exact}{f', {gate.source}' if gate.source else ''}"


def given_band(gate: "Gate") -> Band:
    """The band in numbers."""
    return Band(expect=gate.expect, within=gate.within, at_least=gate.at_least, at_most=gate.at_most)


def _evaluated(found: Quantity[Any], gate: "Gate", scene: "Scene", bench: "Workbench") -> Figure:
    arguments = arguments_of(found, gate.arguments)
    needs_of(found, arguments, scene)  # which refuses what a plan knows will fail, before anything is solved for it
    return evaluate(found, arguments, scene, bench)


def expectation(gate: "Gate") -> str:
    """The band in words, as it was given."""
    return _in_words(given_band(gate))


def _in_words(band: Band) -> str:
    if band.expect is not None:
        value = f"{band.expect.re!r} {band.expect.im:+}i" if isinstance(band.expect, Complex) else repr(band.expect)
        return f"{value} ± {band.within:g}" if band.within is not None else f"contains {value}"
    sides = [f"at least {band.at_least!r}"] * (band.at_least is not None)
    return ", ".join(sides + [f"at most {band.at_most!r}"] * (band.at_most is not None))


def shown_expectation(band: Band) -> str:
    """The same for a person: no more digits than a thousandth of the band."""
    if band.expect is None or band.within is None:
        return _in_words(band)
    parts = (band.expect.re, band.expect.im) if isinstance(band.expect, Complex) else (band.expect,)
    real, *imaginary = (rounded(part, band.within) for part in parts)
    value = f"{real} {imaginary[0] if imaginary[0].startswith('-') else '+' + imaginary[0]}i" if imaginary else real
    return f"{value} ± {band.within:g}"


def _verdict(gate: "Gate", value: Figure) -> tuple[str, float | None]:
    """(reason for failing or '', share of the band used)."""
    if isinstance(value, Bracket):
        return _bracket_verdict(gate, value)
    if isinstance(gate.expect, Complex):
        return _disc_verdict(gate.expect, gate.within, value)
    if isinstance(value, complex) or not isfinite(value):
        return f"measured {in_words(as_plain(value))}, which is not a finite real number", None
    if gate.expect is not None and gate.within is None:
        return f"measured {value!r}, and a number needs within beside expect = {gate.expect!r}", None
    low, high = band(gate)
    share = _share(value, low, high)
    if low <= value <= high:
        return "", share
    side, edge = ("below", low) if value < low else ("above", high)
    return f"measured {value!r} lies {side} {edge!r}", share


def _disc_verdict(expect: Complex, within: float | None, value: Figure) -> tuple[str, float | None]:
    """A complex figure has to lie within a distance of the expected one."""
    if not isinstance(value, complex) or within is None:
        return f"measured {in_words(as_plain(value))}, and a complex expect with within judges complex figures", None
    distance = hypot(value.real - expect.re, value.imag - expect.im) / within
    return ("" if distance <= 1.0 else f"measured {value!r} lies outside the disc"), distance


def band(gate: "Gate") -> tuple[float, float]:
    """The lowest and highest value that pass; infinite where a side is open."""
    if isinstance(gate.expect, float) and gate.within is not None:
        return gate.expect - gate.within, gate.expect + gate.within
    low = -float("inf") if gate.at_least is None else gate.at_least
    return low, float("inf") if gate.at_most is None else gate.at_most


def _share(value: float, low: float, high: float) -> float | None:
    """How much of the band a value uses: its distance from the middle, or for a one-sided band its ratio."""
    if isfinite(low) and isfinite(high):
        half = 0.5 * (high - low)
        return abs(value - 0.5 * (low + high)) / half if half > 0 else None
    if isfinite(high) and high > 0:
        return max(value, 0.0) / high
    return low / value if isfinite(low) and low > 0 and value > 0 else None


def _bracket_verdict(gate: "Gate", value: Bracket) -> tuple[str, float | None]:
    if not isinstance(gate.expect, float) or gate.within is not None:
        return "a two-sided bound needs expect alone: the value it has to contain", None
    share = _share(gate.expect, value.lower, value.upper)
    if value.lower < gate.expect < value.upper:
        return "", share
    return f"measured {value.lower!r} to {value.upper!r}, which does not contain {gate.expect!r}", share
