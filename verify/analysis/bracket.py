"""A value bounded from both sides."""

import msgspec


class Bracket(msgspec.Struct, frozen=True):
    """Two-sided bound on an exact value."""

    lower: float
    upper: float

    @property
    def mean(self) -> float:
        """The middle: the leading errors of both sides cancel, if the lower is not more than three times as far off."""
        return 0.5 * (self.lower + self.upper)

    @property
    def relative_width(self) -> float:
        """Width over mean."""
        return (self.upper - self.lower) / self.mean
