"""Beams of every layout in one call, candidates that are written twice, curvatures by what links weigh."""

from collections.abc import Callable, Hashable, Sequence
from importlib import import_module
from math import pi
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass
from verify.beam import Beam
from verify.stress.chain.written_out import changed_beam
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.modes.any_beam import BODY, FIRST, MASSES, PLAIN, SECTIONS, SPRINGS
from verify.stress.references.beams import held
from verify.stress.references.dense import Elements, Links, Written

# --- In one call ------------------------------------------------------------------------------------------------------

PARTS, MODES = 7, 2
PAIRED = replace(PLAIN, supports=("clamped", "pinned"))
INSIDE = PointMass(position=0.61 * 2.4 / 7.0, mass=0.03, rotary_inertia=3e-5)
ON_A_NODE = PointMass(position=0.61 * 2.0 / 7.0, mass=0.03)
UNLIKE: tuple[Beam, ...] = (
    PAIRED,
    replace(PAIRED, tension=-23.0),
    replace(PAIRED, tension=17.0),
    replace(PAIRED, foundation=1200.0),
    replace(PAIRED, section=SECTIONS),
    replace(PAIRED, mass=(INSIDE,)),
    replace(PAIRED, mass=(ON_A_NODE,)),
    replace(PAIRED, mass=(replace(ON_A_NODE, mass=0.05),)),
    replace(PAIRED, mass=MASSES[:1], spring=SPRINGS, section=SECTIONS),
    replace(PAIRED, supports=("free", "free")),
    replace(PAIRED, supports=("free", "pinned"), spring=(FIRST,), mass=(BODY,)),
)
"""Few of which one stack may take."""
ROOMS = {"fem": "elements", "segment": "segments"}
SETTINGS: tuple[dict[str, Any], ...] = (
    {},
    {"theory": "rayleigh"},
    {"attachment": "lever", "wall": "half"},
)
"""The last are those of links."""


def mixed_error(model: str) -> Callable[[float], float]:
    """Settings -> worst difference between beams and others of their layout solved as one stack, and alone.

    What is compressed, pulled at and thick, or turns with a body at its end on links has no layout.
    """

    def error(number: float) -> float:
        from verify.models.catalogue import MODELS
        from verify.models.stacks import lowest_of_each

        settings, worst = SETTINGS[int(number)], 0.0
        plain = "theory" not in settings
        beams = UNLIKE if plain else UNLIKE[::3]
        groups = laid_together(model, beams, settings)
        alone = sum(
            one.tension < 0.0 or (one.tension and not plain) or (one.mass == (BODY,) and model != "fem")
            for one in beams
        )
        if sum(map(len, groups)) != len(beams) - alone:
            return 1.0
        for group in groups:
            values, sure = lowest_of_each(stack_of(model, group, settings), MODES)
            if not np.all(sure):
                return 1.0
            units = [one.wave_constant * (PARTS / one.length) ** 2 / (2.0 * pi) for one in group]
            for value, unit, one in zip(values.T, units, group, strict=True):
                exact = MODELS[model].solve_modes(one, MODES, PARTS, **settings).frequencies_hz
                worst = largest(worst, float(abs(np.sqrt(value) * unit / exact - 1.0).max()))
        return worst

    return error


def laid_together(model: str, beams: Sequence[Beam], settings: dict[str, Any]) -> list[list[Beam]]:
    """Beams of one layout, those of none left out."""
    room = import_module(f"verify.{ROOMS[model]}.sweeps")
    given = (
        {"n_elements": PARTS, "grading": 1.0, "theory": "euler-bernoulli"} | settings
        if model == "fem"
        else of_links(settings)
    )
    groups: dict[Hashable, list[Beam]] = {}
    for beam in beams:
        shared = room.layout(beam, **given)
        if shared is not None:
            groups.setdefault(shared, []).append(beam)
    return list(groups.values())


def of_links(settings: dict[str, Any]) -> dict[str, Any]:
    """All that says how a chain is set up."""
    from verify.segments.linear import settings_of

    return settings_of("gregory", "series", 1.0, "euler-bernoulli", "reciprocal") | settings


def stack_of(model: str, beams: list[Beam], settings: dict[str, Any]) -> Any:
    """As one."""
    room = import_module(f"verify.{ROOMS[model]}.stacks")
    if model == "fem":
        return room.element_stack(beams, PARTS, 1.0, settings.get("theory", "euler-bernoulli"))
    return room.chain_stack(beams, PARTS, of_links(settings))


# --- Written twice ----------------------------------------------------------------------------------------------------

CANDIDATES = 9
"""Parts of a candidate."""
FAMILIES: tuple[Beam, ...] = (
    changed_beam(held("clamped", "free")),
    held("pinned", "clamped"),
    changed_beam(held("free", "guided")),
)


WEIGHTS = {
    "half": (0.5,),
    "gregory": (3.0 / 8.0, 7.0 / 6.0, 23.0 / 24.0),
    "third-order": (5.0 / 12.0, 13.0 / 12.0),
    "full": (1.0,),
    "stiff": (0.25,),
}
"""How soft joints are from a clamp on, over those of links alike inside."""


def candidates_error(number: float) -> float:
    """Of the frequencies of members of the family, over those of dense matrices of the same links and elements."""
    from verify.identify.family import Candidate, family, frequencies_hz
    from verify.segments.linear import solve_modes

    beam, worst, seen = FAMILIES[int(number)], 0.0, 0
    nodes = solve_modes(beam, 1, CANDIDATES).nodes

    def written(one: Candidate) -> Written | None:
        if one.theory != "euler-bernoulli" or one.attachment or one.mass not in ("links", "consistent"):
            return None
        if one.model == "fem":
            return Elements(beam, nodes)
        plain = one.joints == "series" and (one.wall or "half") in WEIGHTS
        return Links(beam, nodes, np.array(WEIGHTS[one.wall or "half"])) if plain else None

    for one in family(beam):
        own = written(one)
        if own is not None:
            found, seen = frequencies_hz(one, beam, CANDIDATES, 4), seen + 1
            worst = largest(worst, float(abs(found / own.hertz(4) - 1.0).max()) if len(found) == 4 else 1.0)
    return largest(worst, float(seen != 1 + (len(WEIGHTS) if "clamped" in beam.supports else 1)))


# --- Curvatures -------------------------------------------------------------------------------------------------------


def moments_error(number: float) -> float:
    """Of curvatures of links at their joints, against the moment of all that swings beyond a joint over EI there."""
    from verify.segments.linear import solve_modes

    ends, grading = (("clamped", "free"), ("pinned", "free"), ("guided", "free"))[int(number)], 1.0 + 0.3 * number
    beam = changed_beam(held(*ends))
    modes = solve_modes(beam, 3, 11, grading=grading)
    nodes, joints = modes.nodes, modes.readings["raw"]()
    lengths = np.diff(nodes)
    middles, heights = nodes[:-1] + 0.5 * lengths, 0.5 * (joints[:, 1:] + joints[:, :-1])
    pieces = [beam.pieces[int(i)] for i in np.searchsorted(np.cumsum([one.length for one in beam.pieces]), middles)]
    masses = np.array([piece.mass_per_length for piece in pieces]) * lengths
    stiff = np.array([piece.bending_stiffness for piece in pieces])
    squares = (2.0 * np.pi * np.asarray(modes.frequencies_hz)) ** 2
    arms = np.maximum(middles - nodes[:-1, None], 0.0)  # (joint, link)
    turning = masses * lengths / 12.0 * np.diff(joints)
    moments = (masses * heights) @ arms.T + turning @ (arms > 0.0).T
    exact = squares[:, None] * moments / stiff
    found = modes.curvatures()
    return float((abs(found[:, :-1] - exact).max(axis=1) / abs(exact).max(axis=1)).max())


ROWS: tuple[Row, ...] = (
    *(
        Floor(
            id=f"unlike-beams-at-once-{'elements' if model == 'fem' else 'segments'}",
            title="Beams of every layout in one call, none of which is solved with another's matrices",
            why="models/stacks.py: each as right as if it had been asked for alone.",
            along="settings",
            at=(0, 1) if model == "fem" else (0, 2),
            promise=1e-11,
            error=mixed_error(model),
        )
        for model in ("fem", "segment")
    ),
    Floor(
        id="members-written-out",
        title="Chains with five walls and elements as `compare` knows them, against dense matrices",
        why="identify/family.py: members are the package's own models with their settings, or matrices to rounding.",
        along="beam",
        at=tuple(range(len(FAMILIES))),
        promise=1e-10,
        error=candidates_error,
    ),
    Floor(
        id="moments-of-links",
        title="Curvatures of unlike links at their joints, against the moment of what swings beyond over EI there",
        why="segments/links.py: a joint's angle over its compliance is its moment, to rounding.",
        along="ends",
        at=(0, 1, 2),
        promise=1e-10,
        error=moments_error,
    ),
)
