"""How the forces on a beam at rest begin, where nobody says it."""

SOFT_START_PERIODS = 2.0
"""Of the drive. Forces that act at once excite modes without end: under them a slider's path does not converge."""


def soft_start(start: str, periods: float | None) -> float:
    """Periods over which the forces grow: as given, else two from rest and none where the beam moves already."""
    if periods is not None:
        return periods
    return SOFT_START_PERIODS if start == "rest" else 0.0


def grown_in_words(periods: float) -> str:
    """How forces on a beam at rest begin."""
    if not periods:
        return "forces switched on at once"
    return f"forces grown over {periods:g} period{'s' * (periods != 1.0)}"
