"""The one family of errors that a user can cause: one sentence naming field, value and remedy."""

from reprlib import Repr

SENTENCE = 1600
"""Characters of the longest message: what was given in it may be of any length."""
NAMES = 24
"""Of what is known, that a sentence lists."""
VALUE = 120
"""Characters of the longest value shown in one."""


class InputError(ValueError):
    """Bad input. The message is one sentence that names the field, its value and what to do.

    Its middle is left out where it is long, and what no terminal should be sent is escaped.
    """

    def __init__(self, message: str) -> None:
        super().__init__(one_line(message))

    @property
    def sentences(self) -> tuple[str, ...]:
        """One for each thing that is wrong."""
        return (str(self),)


class WrongSceneError(InputError):
    """Several things are wrong with a scene, each a sentence of its own."""

    def __init__(self, sentences: "list[str]") -> None:
        super().__init__("; ".join(sentences))
        self._sentences = tuple(one_line(sentence) for sentence in sentences)

    @property
    def sentences(self) -> tuple[str, ...]:
        """One for each."""
        return self._sentences


def raise_all(sentences: "list[str]", most: int) -> None:
    """Raise InputError for one sentence, WrongSceneError for several, the first `most` of them; nothing for none."""
    sentences = list(dict.fromkeys(sentences))
    if len(sentences) > 1:
        left = [f"and {len(sentences) - most} more"] if len(sentences) > most else []
        raise WrongSceneError([*sentences[:most], *left])
    if sentences:
        raise InputError(sentences[0])


class NoTomlError(InputError):
    """What was named as a scene is no TOML file, so that something else may have been meant."""


class PairingError(InputError):
    """No computed mode has the shape of the exact mode asked for."""


class NoBracketError(InputError):
    """A two-sided bound was asked for where theory or rounding gives none."""


class NoFigureError(InputError):
    """One point of a sweep has no figure, though its neighbours may: a map has a gap there."""


class ResonanceError(NoFigureError):
    """An undamped model is driven at one of its own frequencies."""


class CutOffError(NoFigureError):
    """A mesh is too coarse to carry a wave of this frequency."""


class ZeroFieldError(NoFigureError):
    """Nothing moves, so there is no wave to measure."""


class StandingError(NoFigureError):
    """A standing wave carries nothing, so that nothing can be related to what it carries."""


class WindowError(NoFigureError):
    """A window in which the waves cannot be told apart."""


def near_name(word: str, known: "tuple[str, ...] | list[str]") -> str:
    """The end of a sentence about an unknown word: the nearest known one, or all of them, of many the first."""
    from difflib import get_close_matches

    plain = {name.casefold(): name for name in known}
    close = get_close_matches(word.casefold(), plain, n=1, cutoff=0.6)
    if close:
        return f"did you mean {plain[close[0]]!r}?"
    more = f" and {len(known) - NAMES} more" if len(known) > NAMES + 1 else ""
    return f"known are {', '.join(known[:NAMES] if more else known)}{more}"


def one_line(text: str) -> str:
    """A text of at most SENTENCE printable characters; beginning and end, where field and remedy stand, are kept."""
    return shortened(printable(shortened(text, SENTENCE)), SENTENCE)


def printable(text: str) -> str:
    """A text with what no terminal should be sent escaped: controls, among them those that turn the reading round."""
    return text if text.isprintable() else "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)


class _Short(Repr):
    """`repr` of the first parts of what is long or deep."""

    def __init__(self) -> None:
        super().__init__()
        self.maxlevel, self.maxstring, self.maxother = 3, VALUE // 2, VALUE // 2

    def repr_int(self, x: int, level: int) -> str:
        """A whole number, beyond 100 bits by its length: Python does not print thousands of digits."""
        return repr(x) if x.bit_length() <= 100 else f"a whole number of {x.bit_length()} bits"


def shown(value: object) -> str:
    """A value as a message shows it: `repr`, of its first and last parts where it is long."""
    return shortened(_Short().repr(value), VALUE)


def written(number: float) -> str:
    """A number as a person writes it: 30, where a sum left 30.000000000000004."""
    return f"{number:.12g}"


def shortened(text: str, limit: int) -> str:
    """A text without its middle where it is longer than `limit`."""
    if len(text) <= limit:
        return text
    kept = (limit - 5) // 2
    return f"{text[:kept]} ... {text[-kept:]}"
