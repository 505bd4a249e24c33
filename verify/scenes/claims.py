"""What somebody published about a scene, and which readings of it to try. Data, no numerics."""

from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

from verify.checks import check_number
from verify.errors import InputError
from verify.motion.figures import RUN_FIGURES

Sign = Literal["negative", "positive"]
Read = Literal["stated", "figure", "follows"]
READ = {"stated": "stated in the text", "figure": "read off a figure", "follows": "follows from what is stated"}


class Claim(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One published statement as a figure that this suite can find. It is shown beside what is found; no gate.

    `value` is a number with a `tolerance`, or a sign; `at_least` and `at_most` bound one side each. A quantity of the
    scene's slider without `arguments` is found on the scene's own run, and on every one of its readings. Raises
    InputError where it is none of these.
    """

    id: Annotated[str, Meta(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$")]
    """Letters, digits, _ and -."""
    source: Annotated[str, Meta(min_length=1)]
    """Who says so, and where."""
    quantity: str
    """As `verify quantities` names it."""
    arguments: dict[str, Any] = {}
    """Of the quantity, by name."""
    value: float | Sign | None = None
    """What is claimed: a number, or its sign."""
    tolerance: float | None = None
    """Half the last digit that is printed, or how well a figure can be read."""
    at_least: float | None = None
    """The lowest value that is claimed."""
    at_most: float | None = None
    """The highest value that is claimed."""
    read: Read
    """How the claim was read from its source."""

    def __post_init__(self) -> None:
        for name in ("value", "tolerance", "at_least", "at_most"):
            if (value := getattr(self, name)) is not None and not isinstance(value, str):
                check_number(f"claim.{self.id}.{name}", value, "in the quantity's own unit")
        number = isinstance(self.value, float | int)
        if number != (self.tolerance is not None) or (self.tolerance is not None and self.tolerance <= 0):
            raise InputError(
                f"claim.{self.id}.tolerance = {self.tolerance!r}: give one above 0 beside a number as value, and none "
                "beside a sign or a bound"
            )
        bounded = self.at_least is not None or self.at_most is not None
        if bounded == (self.value is not None):
            raise InputError(f"claim.{self.id} claims nothing clear: give value, or at_least, at_most")
        if self.at_least is not None and self.at_most is not None and self.at_least > self.at_most:
            raise InputError(
                f"claim.{self.id}.at_least = {self.at_least!r} is above at_most = {self.at_most!r}: exchange them"
            )

    @property
    def of_run(self) -> bool:
        """Whether it is about the run of the scene's own slider, and so about every reading of it."""
        return self.quantity in RUN_FIGURES and not self.arguments

    @property
    def number(self) -> float | None:
        """What it claims; None for a sign or a bound."""
        return float(self.value) if isinstance(self.value, float | int) else None

    @property
    def in_words(self) -> str:
        """'-0.015 ± 0.0005', 'negative', 'at least 0.02, at most 0.03'."""
        if self.value is not None:
            return self.value if isinstance(self.value, str) else f"{self.value:g} ± {self.tolerance:g}"
        sides = [f"at least {self.at_least:g}"] if self.at_least is not None else []
        return ", ".join(sides + ([f"at most {self.at_most:g}"] if self.at_most is not None else []))

    def holds(self, found: float) -> bool:
        """Whether a figure is what is claimed; one that is not a number never is."""
        if isinstance(self.value, str):
            return found < 0.0 if self.value == "negative" else found > 0.0
        if self.value is not None and self.tolerance is not None:
            return abs(found - self.value) <= self.tolerance
        low = -float("inf") if self.at_least is None else self.at_least
        return low <= found <= (float("inf") if self.at_most is None else self.at_most)


def asks_for_turned(claims: tuple[Claim, ...]) -> bool:
    """Whether a claim about the slider's run needs the run with all phases turned round."""
    return any(one.of_run and RUN_FIGURES[one.quantity].turned for one in claims)
