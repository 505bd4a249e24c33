"""The four supports of a beam's end by the motions that they prevent: deflection w, rotation w'."""

from collections.abc import Iterable, Mapping
from typing import Literal, NamedTuple

from verify.errors import InputError

Support = Literal["pinned", "clamped", "free", "guided"]


class Fixity(NamedTuple):
    """Motions that a support prevents; its reaction is a shear force against w, a moment against w'."""

    deflection: bool
    rotation: bool


FIXED: dict[str, Fixity] = {
    "pinned": Fixity(deflection=True, rotation=False),
    "clamped": Fixity(deflection=True, rotation=True),
    "guided": Fixity(deflection=False, rotation=True),
    "free": Fixity(deflection=False, rotation=False),
}
"""All supports, as an end has two motions: an elastic or a loaded end is one of them with a spring, mass or device."""
SUPPORTS = tuple(FIXED)


def check_free(
    where: str,
    position: float,
    length: float,
    supports: Iterable[str],
    across: Mapping[str, float],
    turning: Mapping[str, float] | None = None,
) -> None:
    """Raise InputError for a nonzero value at a support of the beam that prevents the motion on which it acts.

    `across` are values by name that act on the deflection at `position`, m, `turning` those on the rotation.
    """
    for end, support in zip((0.0, length), supports, strict=True):
        acts = ((across, FIXED[support].deflection, "moves across"), (turning or {}, FIXED[support].rotation, "turns"))
        for values, prevented, moves in acts if abs(position - end) <= 1e-9 * length else ():
            if prevented and (name := next((name for name, value in values.items() if value), None)):
                raise InputError(
                    f"{where}.position = {position!r} m is on a {support} support, where nothing {moves} and "
                    f"{where}.{name} = {values[name]!r} has no effect: move it or leave that out"
                )
