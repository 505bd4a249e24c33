"""The four supports of a beam's end by what they prevent: deflection w, rotation w'."""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from verify.errors import InputError


class Holds(NamedTuple):
    """What a support prevents; where it prevents w, a shear force is free, where it prevents w', a moment is."""

    deflection: bool
    rotation: bool


HOLDS = {
    "pinned": Holds(deflection=True, rotation=False),
    "clamped": Holds(deflection=True, rotation=True),
    "guided": Holds(deflection=False, rotation=True),
    "free": Holds(deflection=False, rotation=False),
}


def check_moves(
    where: str,
    position: float,
    length: float,
    supports: Iterable[str],
    across: Mapping[str, float],
    turning: Mapping[str, float] | None = None,
) -> None:
    """Raise InputError for a value, not 0, at a support of the beam that prevents the motion on which it acts.

    `across` are values by name that act on the deflection at `position`, m, `turning` those on the rotation.
    """
    for end, support in zip((0.0, length), supports, strict=True):
        acts = ((across, HOLDS[support].deflection, "moves across"), (turning or {}, HOLDS[support].rotation, "turns"))
        for values, held, moves in acts if abs(position - end) <= 1e-9 * length else ():
            if held and (name := next((name for name, value in values.items() if value), None)):
                raise InputError(
                    f"{where}.position = {position!r} m stands on a {support} support, where nothing {moves} and "
                    f"{where}.{name} = {values[name]!r} does nothing: move it, or leave that out"
                )
