"""The one family of errors that a user can cause: one sentence naming field, value and remedy."""


class InputError(ValueError):
    """Bad input. The message is one sentence that names the field, its value and what to do."""


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
    """The end of a sentence about an unknown word: the nearest known one, or all of them."""
    from difflib import get_close_matches

    close = get_close_matches(word, known, n=1, cutoff=0.6)
    return f"did you mean {close[0]!r}?" if close else f"known are {', '.join(known)}"
