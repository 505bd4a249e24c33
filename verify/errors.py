"""Errors that a user can cause: one sentence each, with field, value and remedy."""

from collections.abc import Sequence
from reprlib import Repr
from unicodedata import category

SENTENCE, VALUE = 1600, 120  # largest length of a message, and of a value in a message, characters
NAMES = 12  # largest number of known names in a message


class InputError(ValueError):
    """Invalid input: a sentence for each error, which names the field, its value and the remedy.

    A long message is shortened in its middle; control characters are escaped.
    """

    def __init__(self, *sentences: str) -> None:
        super().__init__(*map(one_line, sentences))

    def __str__(self) -> str:
        return one_line("; ".join(self.args))

    @property
    def sentences(self) -> tuple[str, ...]:
        """The sentences, one for each error."""
        return self.args


class NoBracketError(InputError):
    """A two-sided bound does not exist in theory, or is within rounding."""


class NoFigureError(InputError):
    """A point of a sweep has no value, while its neighbours may have one: a gap in a map.

    Causes: a mesh too coarse for the wave, a zero field, a standing wave without energy flux.
    """


class ResonanceError(NoFigureError):
    """An undamped model is driven at one of its natural frequencies."""


class WindowError(NoFigureError):
    """The two waves cannot be separated in this window."""


def raise_all(sentences: Sequence[str], most: int = 1_000_000) -> None:
    """Raise InputError with the first `most` distinct sentences; no sentences raise nothing."""
    sentences = list(dict.fromkeys(sentences))
    if sentences:
        raise InputError(*sentences[:most], *[f"and {len(sentences) - most} more"] * (len(sentences) > most))


def near_name(word: str, names: Sequence[str]) -> str:
    """The remedy for an unknown name: the nearest known name, else the first `NAMES` known names."""
    if not names:
        return "there is none here, leave it out"
    from difflib import get_close_matches

    plain = {name.casefold(): name for name in names}
    if close := get_close_matches(word.casefold(), plain, n=1):
        return f"did you mean {plain[close[0]]!r}?"
    more = f" and {len(names) - NAMES} more" if len(names) > NAMES + 1 else ""
    return f"known are {', '.join(names[:NAMES] if more else names)}{more}"


def one_line(text: str) -> str:
    """A text of at most SENTENCE printable characters, shortened in its middle."""
    return shortened(printable(shortened(text, SENTENCE)), SENTENCE)


def printable(text: str, keep: str = "") -> str:
    """A text with control characters, but for those in `keep`, and reversed writing direction escaped."""
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() or c in keep or category(c) == "Zs" else repr(c)[1:-1] for c in text)


class _Short(Repr):
    """`repr` of the first parts of a long or deep value."""

    def repr_int(self, x: int, level: int) -> str:
        """A whole number, beyond 100 bits its length: Python prints at most 4300 digits."""
        return repr(x) if x.bit_length() <= 100 else f"a whole number of {x.bit_length()} bits"


def shown(value: object) -> str:
    """A value in a message: its `repr`, shortened."""
    short = _Short()
    short.maxlevel, short.maxstring, short.maxother = 3, VALUE // 2, VALUE // 2
    return shortened(short.repr(value), VALUE)


def written(number: float) -> str:
    """A number to 12 digits, without rounding residues: 30 for 30.000000000000004."""
    return f"{number:.12g}"


def shortened(text: str, limit: int) -> str:
    """A text without its middle where it is longer than `limit` characters."""
    half = (limit - 5) // 2
    return text if len(text) <= limit else f"{text[:half]} ... {text[-half:]}"
