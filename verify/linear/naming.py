"""Arguments that name a model: which models they may name, and how that is checked and listed."""

import msgspec
from msgspec import Meta

from verify.errors import InputError, near_name
from verify.linear.catalogue import MODELS

AMONG = "among"
"""Key of the annotation of an argument that names a model."""
MEAN = "mean"
"""The middle between the model below and the model above, where a model's name is asked for."""


class Among(msgspec.Struct, frozen=True):
    """Which models a name may be of."""

    verb: str
    """One that they have."""
    sized: bool = False
    """Whether they have parts."""
    mean: bool = False
    """Whether the mean of the models below and above is one."""

    def names(self) -> tuple[str, ...]:
        """All of them, in the order of the alphabet."""
        models = [m for m in MODELS.values() if m.can(self.verb) and (m.sized or not self.sized)]
        return (*sorted(m.name for m in models), *([MEAN] if self.mean else []))

    def check(self, name: str, field: str = "model") -> None:
        """Raise InputError, with the nearest that is, for a name that is none of them."""
        if self.mean and name == MEAN:
            return
        found = MODELS.get(name)
        if found is None or not found.can(self.verb) or (self.sized and not found.sized):
            raise InputError(f"{field} = {name!r} is not known: {near_name(name, self.names())}")


def model_meta(meaning: str, verb: str, *, sized: bool = False, mean: bool = False) -> Meta:
    """The annotation of an argument that names a model."""
    return Meta(description=meaning, extra={AMONG: Among(verb, sized, mean)})
