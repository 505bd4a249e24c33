"""Variants, models with their settings, and the rules that a study or a choice compares."""

from collections.abc import Iterable, Mapping
from itertools import product
from typing import TYPE_CHECKING, Any

import msgspec

from verify.analysis.solution_cache import Settings
from verify.errors import InputError
from verify.linear.registry import MODELS, discrete
from verify.problem.beam import Beam
from verify.settings import ModelSettings

_SETTINGS = msgspec.structs.fields(ModelSettings)
DEFAULTS: dict[str, str | float] = {field.name: field.default for field in _SETTINGS}
"""Settings on which frequencies depend, in the order of labels."""
if TYPE_CHECKING:
    _Several = msgspec.Struct
else:  # a type checker knows no table
    _Several = msgspec.defstruct("Several", [(f.name, f.type | tuple[f.type, ...], f.default) for f in _SETTINGS])


class Variant(msgspec.Struct, frozen=True):
    """A model with settings other than its defaults."""

    model: str
    settings: Settings = ()

    @property
    def label(self) -> str:
        """Name in data: 'segment', 'segment wall=half'."""
        return " ".join([self.model, *(f"{name}={value}" for name, value in self.settings)])

    @property
    def title(self) -> str:
        """Title in tables and charts: 'segments', 'segments, wall half'."""
        words = [str(value) if name == "theory" else f"{name} {value}" for name, value in self.settings]
        return ", ".join([MODELS[self.model].title, *words])

    def expected_order(self, beam: Beam) -> int | None:
        """Theoretical order of the frequencies for a beam; None if unknown."""
        model = MODELS[self.model]
        return model.build(beam, max(4 * len(beam.pieces), 16), **dict(self.settings)).expected_order()


class Rules(_Several, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """`ModelSettings` of which each may have several values, which are compared."""

    def variants(self, models: Iterable[str]) -> tuple[Variant, ...]:
        """Each model with all combinations of its settings. Raises InputError for a setting that no model has."""
        names = tuple(models)
        for name, default in DEFAULTS.items():
            changed = [value for value in self._values(name) if value != default]
            if changed and not any(name in MODELS.named(model).settings() for model in names):
                raise InputError(f"{name} = {changed[0]!r} is not a setting of {' or '.join(names)}: leave it out")
        variants = (
            Variant(model, tuple(one for one in chosen if one[0] in MODELS.named(model).settings()))
            for model in names
            for chosen in self.combinations
        )
        return tuple(dict.fromkeys(variants))

    def _values(self, name: str) -> tuple[Any, ...]:
        value = getattr(self, name)
        return value if isinstance(value, tuple) else (value,)

    @property
    def combinations(self) -> tuple[Settings, ...]:
        """All combinations of values, without those equal to their defaults."""
        every = product(*(self._values(name) for name in DEFAULTS))
        return tuple(dict.fromkeys(not_default(dict(zip(DEFAULTS, values, strict=True))) for values in every))

    def alternatives(self, beam: Beam) -> tuple[Variant, ...]:
        """All combinations of the rules of the literature for this beam: wall 2EI/l, tensioned joints, lever."""
        variants = []
        for chosen in map(dict, self.combinations):
            # axial force and shear reduce the order of joints in series by two
            loses = bool(beam.tension) or chosen.get("theory", DEFAULTS["theory"]) != DEFAULTS["theory"]
            rules = [("wall", "half")] * has_wall(beam) + [("joints", "tensioned")] * loses
            rules += [("attachment", "lever")] * attached_within(beam)
            able = ((model.name, *rule) for rule in rules for model in discrete() if rule[0] in model.settings())
            variants += [Variant(model, not_default(chosen | {name: value})) for model, name, value in able]
        return tuple(dict.fromkeys(variants))

    def without_effect(self, beam: Beam) -> dict[str, str]:
        """Settings other than the default without effect on this beam, with the reason."""
        reasons = {"wall": not has_wall(beam) and "no end is clamped"}
        reasons["attachment"] = not beam.attached and "nothing is attached to the beam"
        changed = {name for chosen in self.combinations for name, _ in chosen}
        return {name: f"it has no effect, {why}" for name, why in reasons.items() if why and name in changed}


def has_wall(beam: Beam) -> bool:
    """Whether a chain has a joint at a wall: an end is clamped, or has a rotational spring or rotary inertia."""
    ends = [one.position for one in beam.attached if one.turning]
    return "clamped" in beam.supports or 0.0 in ends or beam.length in ends


def attached_within(beam: Beam) -> bool:
    """Whether attachments on rigid links have an effect: an attachment lies between the ends, or rotates."""
    rotating = any(one.turning for one in beam.attached)
    return rotating or any(0.0 < one.position < beam.length for one in beam.attached)


def is_uneven(beam: Beam) -> bool:
    """Whether errors may oscillate with N: a step or an attachment lies within a part."""
    return len(beam.pieces) > 1 or any(0.0 < one.position < beam.length for one in beam.attached)


def not_default(settings: Mapping[str, str | float]) -> Settings:
    """Settings other than their defaults, in the order of labels."""
    return tuple((name, settings[name]) for name in DEFAULTS if settings.get(name, DEFAULTS[name]) != DEFAULTS[name])
