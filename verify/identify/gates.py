"""The gates of a comparison: the list as it stands, what it is, and where asked its errors against the exact beam."""

from verify.identify.fitting import TOLERANCE, Identified
from verify.identify.pairing import Found
from verify.identify.rows import Row
from verify.run.gates import Band, GateResult
from verify.words import percent


def judged(
    found: Identified, told: tuple[Found, ...], rows: tuple[Row, ...], within: float | None
) -> tuple[GateResult, ...]:
    """The list as it stands, what it is, and where asked its errors against the exact beam."""
    wrong = [one for one in told if one.wrong]
    reason = "; ".join(one.words for one in wrong)
    gates = [
        _gate("list", float(len(wrong)), 0.0, reason, "A list that stands as it is has nothing to be mended.", "1")
    ]
    gates.append(_identified(found, rows))
    if within is not None:
        gates.append(_errors(rows, within))
    return tuple(gates)


def _identified(found: Identified, rows: tuple[Row, ...]) -> GateResult:
    """What the list is said to be, by every entry that is read as a mode."""
    beyond, off = max(((row.beyond, row) for row in rows if row.beyond is not None), key=lambda one: one[0])
    over = f" over {found.best.factor:.6g}" if off.scaled_hz is not None else ""
    reason = ""
    if beyond > TOLERANCE:
        reason = f"mode {off.read_as}{over} is {percent(off.difference)} off the nearest candidate"
    elif found.systematic:
        reason = (
            f"what is left over, up to {percent(off.difference)} at mode {off.read_as}, goes smoothly with the mode"
        )
    elif found.short:
        reason = "of so few frequencies a fit is no evidence: give more of them"
    why = (
        "A model is a member of the family if every mode is its mode, and what is left over does not go with the mode."
    )
    return _gate("identified", beyond, TOLERANCE, reason, why, "1")


def _errors(rows: tuple[Row, ...], within: float) -> GateResult:
    """What was given against the exact beam, whatever it was read as."""
    beyond = [row for row in rows if not abs(row.error) <= within]
    worst = max(rows, key=lambda row: abs(row.error))
    modes = ", ".join(str(row.mode) for row in beyond[:6]) + (" and more" if len(beyond) > 6 else "")
    reason = f"beyond it: mode{'s' * (len(beyond) > 1)} {modes}; the largest error is {percent(worst.error)}"
    why = "Every mode, as it was given, against the exact beam."
    return _gate("within", abs(worst.error), within, reason if beyond else "", why, "1")


def _gate(name: str, measured: float, at_most: float, reason: str, why: str, unit: str) -> GateResult:
    return GateResult(
        id=name,
        quantity=f"compare.{name}",
        arguments={},
        why=why,
        unit=unit,
        expected=f"at most {at_most:g}",
        band=Band(expect=None, within=None, at_least=None, at_most=at_most),
        measured=measured,
        passed=not reason,
        applicable=True,
        share=measured / at_most if at_most else None,
        reason=reason,
        seconds=0.0,
    )
