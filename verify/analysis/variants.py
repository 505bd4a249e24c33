"""A model together with its settings: what stands side by side in a table, a chart or a choice."""

from collections.abc import Iterable, Mapping
from itertools import product
from math import ceil
from typing import Annotated, Any, TypeAlias

import msgspec
from msgspec import Meta

from verify.analysis.solution_cache import Settings
from verify.errors import InputError
from verify.linear.catalogue import MODELS, discrete
from verify.options import WALLS, Attachment, Joints, Theory, Wall
from verify.problem.beam import Beam

DEFAULTS: dict[str, str | float] = {
    "wall": "gregory",
    "joints": "series",
    "grading": 1.0,
    "theory": "euler-bernoulli",
    "attachment": "reciprocal",
}
"""Of the settings that models share, in the order in which they are told."""

SHARED, MOST_SHARED = 2.0, 2000
"""Parts of the shortest section, and of all at most, up to which sizes are looked through for one that fails again."""
Grading: TypeAlias = Annotated[float, Meta(gt=0)]


class Variant(msgspec.Struct, frozen=True):
    """A model with settings other than its defaults."""

    model: str
    settings: Settings = ()

    @property
    def label(self) -> str:
        """Its name in data: 'segment', 'segment wall=half'."""
        return " ".join([self.model, *(f"{name}={value}" for name, value in self.settings)])

    @property
    def title(self) -> str:
        """Its name in a table or a chart: 'segments', 'segments, wall half'."""
        words = [str(value) if name == "theory" else f"{name} {value}" for name, value in self.settings]
        return ", ".join([MODELS[self.model].title, *words])

    @property
    def theory(self) -> str:
        """Of the beam."""
        return str(dict(self.settings).get("theory", DEFAULTS["theory"]))

    def order(self, beam: Beam) -> int | None:
        """The order at which its frequencies converge on a beam, as theory has it; None where nobody says."""
        return MODELS[self.model].order(beam, **dict(self.settings))


class Rules(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How models are set up; several words stand side by side."""

    wall: Wall | tuple[Wall, ...] = "gregory"
    """How segments are held at a clamped end."""
    joints: Joints | tuple[Joints, ...] = "series"
    """The spring between two links."""
    grading: Grading | tuple[Grading, ...] = 1.0
    """Length of a section's last part over its first."""
    theory: Theory | tuple[Theory, ...] = "euler-bernoulli"
    """Of the beam, in every model."""
    attachment: Attachment | tuple[Attachment, ...] = "reciprocal"
    """How segments feel point masses and springs."""

    def variants(self, models: Iterable[str]) -> tuple[Variant, ...]:
        """Each model with each of the settings that it has. Raises InputError for one that no model has."""
        names = tuple(models)
        self._check_known(names)
        found: dict[Variant, None] = {}
        for model in names:
            known = [name for name in DEFAULTS if name in MODELS.named(model).modal_settings]
            for values in product(*(self._several(name) for name in known)):
                pairs = zip(known, values, strict=True)
                found[Variant(model, tuple((name, value) for name, value in pairs if value != DEFAULTS[name]))] = None
        return tuple(found)

    def _several(self, name: str) -> tuple[Any, ...]:
        value = getattr(self, name)
        return value if isinstance(value, tuple) else (value,)

    def _check_known(self, models: tuple[str, ...]) -> None:
        for name, default in DEFAULTS.items():
            turned = [value for value in self._several(name) if value != default]
            if turned and not any(name in MODELS.named(model).modal_settings for model in models):
                raise InputError(f"{name} = {turned[0]!r} is a setting of none of {', '.join(models)}: leave it out")

    @property
    def several(self) -> tuple[str, ...]:
        """Settings of several words."""
        return tuple(name for name in DEFAULTS if len(self._several(name)) > 1)

    @property
    def combinations(self) -> tuple[Settings, ...]:
        """Every word of each setting with every word of the others, defaults left out."""
        every = product(*(self._several(name) for name in DEFAULTS))
        return tuple(dict.fromkeys(told(dict(zip(DEFAULTS, words, strict=True))) for words in every))

    def beside(self, beam: Beam) -> tuple[Variant, ...]:
        """The rules that stand beside each combination on this beam (`beside`), each once."""
        return tuple(dict.fromkeys(one for chosen in self.combinations for one in beside(beam, chosen)))

    def every_rule(self, beam: Beam) -> tuple[Variant, ...]:
        """Every rule that makes a difference on this beam by each combination (`every_rule`), each once."""
        return tuple(dict.fromkeys(one for chosen in self.combinations for one in every_rule(beam, chosen)))


def models_with(name: str) -> tuple[str, ...]:
    """The models of parts that have a setting."""
    return tuple(model.name for model in discrete() if name in model.modal_settings)


def has_wall(beam: Beam) -> bool:
    """Whether an end turns against something or turns something, so that a chain has a joint at a wall there."""
    turned = [s.position for s in beam.spring if s.rotational] + [m.position for m in beam.mass if m.rotary_inertia]
    return "clamped" in beam.supports or 0.0 in turned or beam.length in turned


def falls_within(beam: Beam) -> bool:
    """Whether something may fall anywhere within a part, so that errors go up and down with the number of parts."""
    places = [m.position for m in beam.mass] + [s.position for s in beam.spring]
    return len(beam.pieces) > 1 or any(0.0 < place < beam.length for place in places)


def shared_from(beam: Beam) -> int:
    """From how many parts on the shortest section has some of its own: below, errors may fall and rise once more.

    As long as it has one it is longer or shorter than those beside it, by more or less with every number of them.
    """
    shortest = min(piece.length for piece in beam.pieces) / beam.length
    return min(ceil(SHARED / shortest), MOST_SHARED) if len(beam.pieces) > 1 else 0


def told_by_lever(beam: Beam) -> bool:
    """Whether links that carry bodies and springs as they are differ from others: not at an end, where none turns."""
    turning = any(m.rotary_inertia for m in beam.mass) or any(s.rotational for s in beam.spring)
    places = [m.position for m in beam.mass] + [s.position for s in beam.spring]
    return turning or any(0.0 < place < beam.length for place in places)


def beside(beam: Beam, chosen: Settings = ()) -> tuple[Variant, ...]:
    """The rules that stand beside the default on this beam: the literature's wall and attachment, the joint that mends.

    Axial force and thickness take two orders from joints in series; what else is chosen is kept.
    """
    loses = bool(beam.tension) or dict(chosen).get("theory", DEFAULTS["theory"]) != DEFAULTS["theory"]
    other = [("wall", "half")] * has_wall(beam) + [("joints", "tensioned")] * loses
    other += [("attachment", "lever")] * told_by_lever(beam)
    return tuple(Variant(model, told(dict(chosen) | dict([one]))) for one in other for model in models_with(one[0]))


def every_rule(beam: Beam, chosen: Settings = ()) -> tuple[Variant, ...]:
    """Every rule of a chain that makes a difference on this beam: walls, joints, attachments; the rest as chosen."""
    thick = dict(chosen).get("theory", DEFAULTS["theory"]) != DEFAULTS["theory"]
    uneven = bool(beam.section) or not beam.uniform or thick or dict(chosen).get("grading", 1.0) != 1.0
    walls = [w for w in WALLS[1:] if w != "welded" or not uneven] if has_wall(beam) else []
    rules = [("wall", wall) for wall in walls]
    rules += [("joints", "printed")] * (beam.stepped and all(p.youngs_modulus for p in beam.pieces))
    rules += [("joints", "tensioned")] * (bool(beam.tension) or thick)
    rules += [("attachment", "lever")] * bool(beam.mass or beam.spring)
    return tuple(Variant(model, told(dict(chosen) | dict([rule]))) for rule in rules for model in models_with(rule[0]))


def without_effect(beam: Beam, rules: Rules) -> dict[str, str]:
    """Settings that somebody turned and that change nothing on this beam, each with the reason."""
    reasons = {
        "wall": "" if has_wall(beam) else "no end is clamped",
        "attachment": "" if beam.mass or beam.spring else "nothing stands on the beam",
    }
    turned = {name for chosen in rules.combinations for name, _ in chosen}
    return {name: f"it makes no difference here, {why}" for name, why in reasons.items() if why and name in turned}


def told(settings: Mapping[str, str | float]) -> Settings:
    """Settings other than their defaults, in the order in which they are told."""
    return tuple((name, settings[name]) for name in DEFAULTS if settings.get(name, DEFAULTS[name]) != DEFAULTS[name])
