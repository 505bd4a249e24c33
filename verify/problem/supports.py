"""The four supports of a beam's end by what they prevent: deflection w, rotation w'."""

from typing import NamedTuple


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
