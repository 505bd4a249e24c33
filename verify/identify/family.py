"""The known family: what a list of frequencies may be of, each candidate a value with its order, words and solver."""

from collections.abc import Iterator
from functools import lru_cache
from itertools import product

import msgspec
import numpy as np

from verify.beam import Beam
from verify.errors import InputError
from verify.identify import matrices
from verify.judge.variants import falls_within, has_wall, told_by_lever
from verify.models.arrays import Array
from verify.models.catalogue import MODELS
from verify.options import JOINTS, THEORIES, WALLS

EXACT, CHAIN, ELEMENTS = "analytic", "segment", "fem"
_WALLS = {
    "half": "follows the 2EI/l rule at the wall",
    "gregory": "has Gregory's weights 3/8, 7/6, 23/24 at the wall",
    "welded": "has half a segment welded to the wall",
    "third-order": "has the weights 5/12, 13/12 at the wall",
    "five-joint": "has the five-joint weights at the wall",
    "full": "has a whole joint EI/l at the wall",
    "rigid": "has a first link held fast by the wall",
    "stiff": "has a joint 4EI/l at the wall, twice as stiff as it should be",
}
_WALL_ORDERS = {
    "half": 2,
    "gregory": 4,
    "welded": 2,
    "third-order": 3,
    "five-joint": 4,
    "full": 1,
    "rigid": 1,
    "stiff": 1,
}
_LINKS = {
    "links": "has rigid links with their own inertia m l^2/12",
    "points": "has links without their own inertia m l^2/12",
    "joints": "has its mass lumped at the joints",
}
_RULES = {"series": "", "printed": "takes Eq. (1) as printed", "tensioned": "has joints that know the tension"}
_HELD = "carries what is fixed to it on its links as they are"
_NODES = {
    "consistent": "cubic Hermite elements with consistent mass",
    "lumped": "cubic Hermite elements with mass lumped at the nodes",
    "lumped-rotary": "cubic Hermite elements with mass and rotary inertia m l^2/24 lumped at the nodes",
    "hrz": "cubic Hermite elements with HRZ-lumped mass (m l^2/78)",
    "linear": "linear Timoshenko elements, reduced integration, consistent mass",
    "linear-lumped": "linear Timoshenko elements, reduced integration, lumped mass",
}
_THEORIES = {
    "euler-bernoulli": "",
    "rayleigh": "with the section's rotary inertia (Rayleigh)",
    "timoshenko": "with shear and rotary inertia (Timoshenko)",
}


class Candidate(msgspec.Struct, frozen=True, kw_only=True):
    """One member of the family."""

    model: str
    """analytic, segment or fem."""
    wall: str | None = None
    """How a clamped end is held; None where none is, or no chain is held so."""
    joints: str | None = None
    """The rule of a chain's joints; None for other models."""
    mass: str | None = None
    """Of a chain: links, points, joints; of elements: consistent, lumped, lumped-rotary, hrz, linear, linear-lumped."""
    theory: str = "euler-bernoulli"
    order: int | None = None
    """With which its frequencies converge on this beam; None of the exact beam, and where nobody says."""
    attachment: str | None = None
    """lever of a chain whose links carry point masses and springs as rigid bodies do; None of others."""
    shearing: bool = False
    """Whether it is a rod whose nodes and turns move apart (Cosserat)."""

    @property
    def sized(self) -> bool:
        """Whether it has parts."""
        return self.model != EXACT

    @property
    def words(self) -> str:
        """What it is, as a noun: 'a chain that ...'."""
        if self.model == EXACT:
            return " ".join(["the exact beam", _THEORIES[self.theory]]).strip()
        if self.model == ELEMENTS:
            return " ".join([_NODES[self.mass or ""], _THEORIES[self.theory]]).strip()
        return f"{'a rod' if self.shearing else 'a chain'} that {self._clauses()}"

    @property
    def answer(self) -> str:
        """The sentence about a user's model that is this one, without its full stop."""
        if self.model == EXACT:
            return f"Your frequencies are those of {self.words}"
        if self.model == ELEMENTS:
            return f"Your model is one of {self.words}{self._ordered}"
        return f"Your {'rod' if self.shearing else 'chain'} {self._clauses()}{self._ordered}"

    @property
    def _ordered(self) -> str:
        """Its order, where one is due."""
        return f", order {self.order}" if self.order else ""

    def _clauses(self) -> str:
        """What makes a chain this one and no other: of the links' own inertia only where there is no more to say."""
        said = [_WALLS[self.wall]] if self.wall else []
        said += [_LINKS[self.mass or ""]] * (self.mass != "links" or not self.wall)
        said += [_RULES[self.joints or ""]] * (self.joints != "series")
        said += [_HELD] * (self.attachment is not None)
        joined = f"{', '.join(said[:-1])} and {said[-1]}" if len(said) > 1 else said[0]
        theory = _THEORIES[self.theory]
        return f"{joined}, {theory}" if theory else joined

    @property
    def settings(self) -> tuple[tuple[str, str | float], ...]:
        """What the package's own model is told, where it is one."""
        given = {"wall": self.wall, "joints": self.joints if self.joints != "series" else None}
        given["attachment"] = self.attachment
        if self.theory != "euler-bernoulli":
            given["theory"] = self.theory
        return tuple((name, value) for name, value in given.items() if value is not None)

    @property
    def packaged(self) -> bool:
        """Whether a model of the package is this one."""
        own = self.model == CHAIN and (self.mass, self.wall or "half") in {("links", wall) for wall in WALLS}
        return self.model == EXACT or own or (self.model == ELEMENTS and self.mass == "consistent")


def family(beam: Beam) -> tuple[Candidate, ...]:
    """Every candidate that may stand for a model of this beam; which of them do not exist for it, solving says."""
    return (*_chains(beam), *_elements(beam), *(Candidate(model=EXACT, theory=theory) for theory in THEORIES))


def _chains(beam: Beam) -> Iterator[Candidate]:
    clamped = "clamped" in beam.supports
    walls: tuple[str | None, ...] = (
        ("half", *(w for w in WALLS if w != "half"), "full", "rigid", "stiff") if clamped else (None,)
    )
    elastic = has_wall(beam) and not clamped  # an end that turns against a spring has the joint of a wall
    made: tuple[str | None, ...] = ("half", *(w for w in WALLS if w not in ("half", "welded"))) if elastic else walls
    rules = ["series"] + ["printed"] * beam.stepped + ["tensioned"] * bool(beam.tension)
    for joints, wall, theory in product(rules, made, THEORIES):
        euler_alone = wall == "welded" and theory != "euler-bernoulli"
        if not euler_alone and (theory != "timoshenko" or wall not in ("full", "rigid", "stiff")):
            order = _order(beam, wall, joints, theory)
            yield Candidate(model=CHAIN, wall=wall, joints=joints, mass="links", theory=theory, order=order)
    if told_by_lever(beam):
        for joints, wall in product(rules, [wall for wall in walls if wall in (None, "half", "gregory")]):
            order = _order(beam, wall, joints, attachment="lever")
            yield Candidate(model=CHAIN, wall=wall, joints=joints, mass="links", attachment="lever", order=order)
    plain = [wall for wall in walls if wall in (None, "half", "gregory", "full", "rigid")]
    for mass, wall in product(("points", "joints"), plain):
        order = min(_order(beam, wall, "series") or 2, 2)
        yield Candidate(model=CHAIN, wall=wall, joints="series", mass=mass, order=order)
    for wall in plain:
        if wall == "gregory":
            continue
        order = min(_order(beam, wall, "series") or 2, 2)
        yield Candidate(
            model=CHAIN, wall=wall, joints="series", mass="joints", theory="timoshenko", order=order, shearing=True
        )


def goes_up_and_down(beam: Beam, candidate: Candidate) -> bool:
    """Whether the errors of a candidate go up and down with its size, by what falls within a part."""
    return candidate.sized and falls_within(beam)


def inner_places(beam: Beam) -> tuple[float, ...]:
    """Where bodies and springs stand between the ends, of the length."""
    places = {m.position for m in beam.mass} | {s.position for s in beam.spring}
    return tuple(sorted(place / beam.length for place in places if 0.0 < place < beam.length))


def _order(
    beam: Beam, wall: str | None, joints: str, theory: str = "euler-bernoulli", attachment: str = "reciprocal"
) -> int | None:
    """Of links with their own inertia: at most the wall's, and as the package's own chain has it on this beam."""
    known = MODELS[CHAIN].order(beam, joints=joints, theory=theory, attachment=attachment)
    return None if known is None else min(known, _WALL_ORDERS[wall] if wall else 4)


def _elements(beam: Beam) -> Iterator[Candidate]:
    # without rotary inertia at the nodes, -mu^4/1440 but where half an element's mass sits at a free end
    even = "free" not in beam.supports and not beam.stepped
    orders = {"consistent": 4, "lumped": 4 if even else 2, "lumped-rotary": 2, "hrz": 2}
    for (mass, order), theory in product(orders.items(), THEORIES):
        thick = theory != "euler-bernoulli" and mass == "lumped"
        yield Candidate(model=ELEMENTS, mass=mass, theory=theory, order=2 if thick else order)
    for mass in ("linear", "linear-lumped"):
        yield Candidate(model=ELEMENTS, mass=mass, theory="timoshenko", order=2)


class Solver:
    """The frequencies of candidates on one beam, and why some are left out."""

    def __init__(self, beam: Beam, n_modes: int) -> None:
        """Up to `n_modes` are asked of each."""
        self.beam, self.n_modes = beam, n_modes
        self.left_out: dict[Candidate, str] = {}
        self.asked: set[tuple[Candidate, int | None]] = set()
        """What was solved for, candidates that exist alone."""

    def __call__(self, candidate: Candidate, count: int | None) -> Array:
        """Its first frequencies, (n_modes or as many as it has,), Hz. Raises InputError where it does not exist."""
        size = count if candidate.sized else None
        found = frequencies_hz(candidate, self.beam, size, self.n_modes)
        self.asked.add((candidate, size))
        return found

    def or_nothing(self, candidate: Candidate, count: int | None) -> Array:
        """The same; empty, and the reason kept, where it does not exist."""
        try:
            return self(candidate, count)
        except InputError as why:
            self.left_out[candidate] = str(why)
            return np.empty(0)


@lru_cache(maxsize=10_000)
def frequencies_hz(candidate: Candidate, beam: Beam, count: int | None, n_modes: int) -> Array:
    """The first frequencies of a candidate, (n_modes or as many as it has,), Hz; kept, and not to be written to.

    Raises InputError where it does not exist on this beam, at this size, or by this theory.
    """
    if candidate.model == EXACT:
        return exact_hz(beam, n_modes, candidate.theory)
    assert count is not None
    thick = candidate.theory == "rayleigh" and "theory" not in MODELS[CHAIN].modal_settings
    if candidate.packaged and not (thick and candidate.model == CHAIN and candidate.joints == "series"):
        return _packaged(candidate, beam, count, n_modes)
    given = {"beam": beam, "count": count, "n_modes": n_modes}
    if candidate.model == ELEMENTS:
        return matrices.elements(**given, mass=candidate.mass or "", theory=candidate.theory)  # type: ignore[arg-type]
    if candidate.shearing:
        return matrices.rod(**given, wall=candidate.wall or "half")  # type: ignore[arg-type]
    return matrices.chain(
        **given,  # type: ignore[arg-type]
        wall=candidate.wall or "half",
        mass=candidate.mass or "",
        theory=candidate.theory,
    )


def _packaged(candidate: Candidate, beam: Beam, count: int, n_modes: int) -> Array:
    model = MODELS[candidate.model]
    settings = dict(candidate.settings)
    if candidate.theory != "euler-bernoulli" and "theory" not in model.modal_settings:
        raise InputError(f"theory = {candidate.theory!r}: the {candidate.model} model has none but euler-bernoulli")
    if candidate.joints is not None and candidate.joints not in JOINTS:
        raise InputError(f"joints = {candidate.joints!r} is not known to the {candidate.model} model")
    if count < model.fewest:
        return np.empty(0)
    available = min(n_modes, model.n_elastic(beam, count), model.n_elastic(beam, count, **settings))
    if available < 1:
        return np.empty(0)
    return np.asarray(model.solve_modes(beam, available, count, **settings).frequencies_hz)


def exact_hz(beam: Beam, n_modes: int, theory: str = "euler-bernoulli") -> Array:
    """The exact frequencies by a theory, (n_modes,), Hz. Raises InputError where they are not known."""
    if beam.uniform:
        from verify.exact.closed_forms import frequency_hz

        try:
            return np.array([frequency_hz(beam, mode, theory) for mode in range(1, n_modes + 1)])
        except InputError:
            if "theory" not in MODELS[EXACT].modal_settings:
                raise
    if theory == "euler-bernoulli":
        from verify.exact.modes import exact_frequency_hz

        return np.array([exact_frequency_hz(beam, mode) for mode in range(1, n_modes + 1)])
    if "theory" not in MODELS[EXACT].modal_settings:
        raise InputError(f"theory = {theory!r} has no exact frequencies here for this beam")
    asked: dict[str, str | float] = {"theory": theory}
    return np.asarray(MODELS[EXACT].solve_modes(beam, n_modes, None, **asked).frequencies_hz)  # type: ignore[arg-type]
