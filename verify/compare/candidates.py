"""Candidate discretisations of a beam: wall rule, mass model, theory; their frequencies with N parts."""

from collections.abc import Iterator
from functools import lru_cache
from itertools import product

import msgspec
import numpy as np

from verify.analysis.variants import attached_within, has_wall
from verify.arrays import Array
from verify.compare.discrete import STEPS, DiscreteBeam
from verify.linear.registry import MODELS
from verify.problem.beam import Beam, is_stepped
from verify.segments.orders import order_of
from verify.settings import DEFAULT, THEORIES, WALLS, wall_label

EXACT, CHAIN, ELEMENTS = "analytic", "segment", "fem"
EULER = "euler-bernoulli"
LABELS = {
    EXACT: "exact beam",
    "links": "rigid links",
    "points": "rigid links with point masses",
    "halves": "rigid links with half links at both ends, joints EI/l",
    "joints": "links with mass lumped at the joints",
    "rod": "Cosserat rod with mass lumped at the nodes",
    "consistent": "Hermite elements, consistent mass",
    "lumped": "Hermite elements, lumped mass",
    "lumped-rotary": "Hermite elements, lumped mass and rotary inertia m l^2/24",
    "hrz": "Hermite elements, HRZ-lumped mass",
    "linear": "linear Timoshenko elements, consistent mass",
    "linear-lumped": "linear Timoshenko elements, lumped mass",
    "printed": "Eq. (1) as printed",
    "tensioned": "joints corrected for tension",
    "lever": "attachments on their rigid link",
} | STEPS
"""Labels of models, mass, joints, attachments and theories; those of walls are in `settings`."""


class Candidate(msgspec.Struct, frozen=True, kw_only=True):
    """A discretisation without its N: model analytic, segment or fem.

    `mass` of a chain: links, halves, points, joints, rod; of elements: consistent, lumped, lumped-rotary, hrz,
    linear(-lumped).
    `wall`: rule of a chain at a clamped end; None without one.
    """

    model: str
    mass: str = ""
    wall: str | None = None
    joints: str = DEFAULT.joints
    attachment: str = DEFAULT.attachment
    theory: str = DEFAULT.theory

    @property
    def sized(self) -> bool:
        """Whether the candidate is discrete."""
        return self.model != EXACT

    @property
    def label(self) -> str:
        """Name in tables."""
        wall = [wall_label(self.wall)] if self.wall else []
        rules = [LABELS[rule] for rule in (self.joints, self.attachment) if rule in LABELS]
        theory = [self.theory.capitalize()] if self.theory != EULER else []
        return ", ".join([LABELS[self.mass or self.model], *wall, *rules, *theory])

    @property
    def packaged(self) -> bool:
        """Whether the candidate is a model of `verify`."""
        fault = self.wall is not None and WALLS[self.wall].fault
        chain = self.mass == "links" and not fault and self.joints not in STEPS
        return not self.sized or self.mass == "consistent" or chain

    def order(self, beam: Beam) -> int | None:
        """Order of convergence of the frequencies for a beam; None if unknown."""
        if not self.sized:
            return None
        if self.model == ELEMENTS:
            even = "free" not in beam.supports and not is_stepped(beam) and self.theory == EULER
            return 4 if self.mass == "consistent" or (self.mass == "lumped" and even) else 2
        if self.mass == "halves":
            return 2
        if self.joints in STEPS:
            return None if self.joints == "centre" else 1
        rules = {"wall": self.wall or DEFAULT.wall, "joints": self.joints, "attachment": self.attachment}
        order = order_of(beam, **rules, grading=1.0, theory=EULER if self.mass == "rod" else self.theory)
        return order if order is None or self.mass == "links" else min(order, 2)


def candidates(beam: Beam, kind: str | None = None) -> tuple[Candidate, ...]:
    """All candidates for a beam, or the exact beam and those of a kind, 'segments' or 'elements'."""
    chains = _chains(beam) if kind != "elements" else ()
    theories = (EULER,) if beam.tension else THEORIES  # under an axial force the others are not unique
    masses = ("consistent", "lumped", "lumped-rotary", "hrz") if kind != "segments" else ()
    linear = ("linear", "linear-lumped") if masses else ()
    return (
        *chains,
        *(Candidate(model=ELEMENTS, mass=mass, theory=theory) for mass, theory in product(masses, theories)),
        *(Candidate(model=ELEMENTS, mass=mass, theory="timoshenko") for mass in linear if len(theories) > 1),
        *(Candidate(model=EXACT, theory=theory) for theory in theories),
    )


def _chains(beam: Beam) -> Iterator[Candidate]:
    """Rigid links with all rules; other mass models with the usual wall rules."""
    clamped = "clamped" in beam.supports
    faults = [name for name, rule in WALLS.items() if rule.fault]
    every = [name for name in WALLS if clamped or name not in faults]
    walls = sorted(every, key=lambda name: name != "half") if clamped or has_wall(beam) else [None]
    rules = ["series"] + ["printed"] * is_stepped(beam) + ["tensioned"] * bool(beam.tension)
    for joints, wall, theory in product(rules, walls, (EULER,) if beam.tension else THEORIES):
        if (wall == "welded" and (theory != EULER or not clamped)) or (wall in faults and theory == "timoshenko"):
            continue
        yield Candidate(model=CHAIN, mass="links", wall=wall, joints=joints, theory=theory)
    common: tuple[str | None, ...] = ("half", "gregory", "full", "rigid") if clamped else (None,)
    if attached_within(beam):
        for joints, wall in product(rules, [wall for wall in common if wall not in faults]):
            yield Candidate(model=CHAIN, mass="links", wall=wall, joints=joints, attachment="lever")
    for joints, wall in product(STEPS if is_stepped(beam) else (), common):
        yield Candidate(model=CHAIN, mass="links", wall=wall, joints=joints)
    if not beam.uniform or set(beam.supports) != {"pinned"}:  # there whole links have the same frequencies
        yield Candidate(model=CHAIN, mass="halves")
    for mass, wall in product(("points", "joints"), common):
        yield Candidate(model=CHAIN, mass=mass, wall=wall)
    for wall in common if not beam.tension else ():
        if wall != "gregory":
            yield Candidate(model=CHAIN, mass="rod", wall=wall, theory="timoshenko")


@lru_cache(maxsize=20_000)
def frequencies_hz(candidate: Candidate, beam: Beam, count: int | None, n_modes: int) -> Array:
    """First elastic frequencies of a candidate, (n_modes or fewer,), Hz; cached, read-only. Raises InputError."""
    if candidate.packaged:
        chosen = {name: getattr(candidate, name, None) for name in MODELS[candidate.model].settings()}
        rules = {name: rule for name, rule in chosen.items() if rule is not None}
        if count is not None and count < MODELS[candidate.model].fewest:
            return np.empty(0)
        model = MODELS[candidate.model].build(beam, count, **rules)
        n_modes = n_modes if count is None else min(n_modes, model.n_elastic)
        return np.asarray(model.modes(n_modes).frequencies_hz) if n_modes > 0 else np.empty(0)
    line, wall = DiscreteBeam(beam, count or 0, candidate.theory, candidate.joints), candidate.wall or "half"
    if candidate.model == ELEMENTS:
        return line.elements_hz(n_modes, candidate.mass)
    if candidate.mass == "halves":
        return line.halves_hz(n_modes)
    return line.rod_hz(n_modes, wall) if candidate.mass == "rod" else line.chain_hz(n_modes, candidate.mass, wall)
