"""What the judge stands models side by side by: rules of a beam, brackets, sizes; drives at the edge of a search."""

from functools import partial
from math import pi

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass, PointSpring
from verify.beam import Beam, PointForce
from verify.judge.variants import Rules, Variant, beside, every_rule, without_effect
from verify.judge.workbench import Settings, Workbench, comparable, has_bracket
from verify.section import Section
from verify.stress.judge.sizes_chosen import pinned_error
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STEPPED, STRIP, held

CLAMPED = held("clamped", "free")
TAUT = replace(STRIP, tension=40.0)
LOADED = replace(STRIP, mass=(PointMass(position=0.29, mass=0.05),))
TURNED = replace(STRIP, spring=(PointSpring(position=0.73, rotational=9.0),))
MIXED = replace(
    STRIP, section=(Section(length=0.4), Section(length=0.33, youngs_modulus=70e9, thickness=0.003)), tension=3.0
)
THICK: Settings = (("theory", "timoshenko"),)
WALLS = ("half", "third-order", "five-joint")
EXPECTED: tuple[tuple[Beam, Settings, tuple[tuple[str, str], ...], tuple[tuple[str, str], ...]], ...] = (
    (STRIP, (), (), ()),
    (CLAMPED, (), (("wall", "half"),), (*(("wall", wall) for wall in ("half", "welded", *WALLS[1:])),)),
    (STEPPED, (), (), (("joints", "printed"),)),
    (TAUT, (), (("joints", "tensioned"),), (("joints", "tensioned"),)),
    (STRIP, THICK, (("joints", "tensioned"),), (("joints", "tensioned"),)),
    (
        CLAMPED,
        THICK,
        (("wall", "half"), ("joints", "tensioned")),
        (*(("wall", w) for w in WALLS), ("joints", "tensioned")),
    ),
    (LOADED, (), (("attachment", "lever"),), (("attachment", "lever"),)),
    (TURNED, (), (("wall", "half"), ("attachment", "lever")), (*(("wall", w) for w in WALLS), ("attachment", "lever"))),
    (MIXED, (), (("joints", "tensioned"),), (("joints", "printed"), ("joints", "tensioned"))),
)
"""Beams with settings, the rules that stand beside the default on them, and every rule that makes a difference."""


def rules_error(number: float) -> float:
    """How often other rules stand beside the default on a beam, or another set of all of them."""
    beam, chosen, few, every = EXPECTED[int(number)]
    wrong = 0
    for found, expected in ((beside(beam, chosen), few), (every_rule(beam, chosen), every)):
        added = sorted(str(pair) for one in found for pair in one.settings if pair not in chosen)
        wrong += added != sorted(str(pair) for pair in expected)
        wrong += any(one.model != "segment" for one in found)
        wrong += any(set(chosen) - set(one.settings) != set() for one in found)
    return float(wrong)


def words_error(number: float) -> float:
    """How many names, orders and remarks of variants and settings are other than they should be."""
    wide = Rules(wall=("gregory", "half"), grading=2.0)
    thick = Rules(theory=("euler-bernoulli", "timoshenko"))
    found = wide.variants(("segment", "fem"))
    labels = ["segment grading=2.0", "segment wall=half grading=2.0", "fem grading=2.0"]
    wrong = int([one.label for one in found] != labels)
    wrong += [one.title for one in found][1] != "segments, wall half, grading 2.0"
    wrong += [one.order(CLAMPED) for one in found] != [2, 2, 4]
    wrong += Variant("fem", THICK).theory != "timoshenko" or Variant("fem").theory != "euler-bernoulli"
    wrong += wide.combinations != ((("grading", 2.0),), (("wall", "half"), ("grading", 2.0)))
    wrong += wide.several != ("wall",) or {one.label for one in wide.beside(CLAMPED)} != {labels[1]}
    told = [one.settings for one in thick.every_rule(CLAMPED)]
    plain = [(("wall", wall),) for wall in ("half", "welded", *WALLS[1:])]
    shearing = [*((("wall", wall), *THICK) for wall in WALLS), (("joints", "tensioned"), *THICK)]
    wrong += sorted(map(sorted, told)) != sorted(map(sorted, [*plain, *shearing]))
    turned = Rules(wall="half", attachment="lever")
    wrong += set(without_effect(STRIP, turned)) != {"wall", "attachment"}
    wrong += set(without_effect(CLAMPED, turned)) != {"attachment"} or bool(without_effect(STRIP, Rules()))
    wrong += Variant("segment", (("attachment", "lever"),)).order(TURNED) != 1
    wrong += Variant("segment", (("attachment", "lever"),)).order(LOADED) != 2
    return float(wrong)


def brackets_error(mode: float) -> float:
    """Of the bracket of a pinned strip, its middle and width, by its dispersion; and of where there is none."""
    n, number = 14, int(mode)
    bench, exact = Workbench(STRIP), STRIP.wave_constant * (number * pi / STRIP.length) ** 2 / (2.0 * pi)
    low, high = (exact * (1.0 + pinned_error(model, number, n)) for model in ("segment", "fem"))
    found = bench.bracket(number, n)
    pairs = [(found.lower, low), (found.upper, high), (bench.frequency_hz("mean", n, number), 0.5 * (low + high))]
    pairs += [(1.0 + found.relative_width, 1.0 + 2.0 * (high - low) / (high + low)), (bench.exact_hz(number), exact)]
    pairs += [(bench.paired_frequency_hz("mean", n, number), 0.5 * (low + high))]
    worst = max(abs(one / other - 1.0) for one, other in pairs)
    wrong = int([has_bracket(beam) for beam in (STRIP, CLAMPED, STEPPED, TAUT)] != [True, False, False, False])
    wrong += comparable(CLAMPED, (9, 20), 3) != (["segment", "fem"], {})
    none, why = bench.error_or_why("segment", 5, 9)
    wrong += none is not None or "mode = 9" not in why
    wrong += not abs((bench.error_or_why("segment", n, number)[0] or 0.0) - pinned_error("segment", number, n)) <= 1e-12
    return largest(worst, float(wrong))


def chosen_error(mode: float) -> float:
    """By how many parts sizes that are chosen side by side miss those from which on 1 % is kept, of every size."""
    from verify.judge.sizing import choose

    number, missed = int(mode), 0.0
    for one in choose(Workbench(STRIP), number, 0.01):
        errors = {n: abs(pinned_error(one.model, number, n)) for n in range(number + 1, 90)}
        exact = max((n for n, error in errors.items() if error > 0.01), default=number) + 1
        missed += abs(one.count - exact) + (one.lower != ()) + (one.run_time_s <= 0.0)
        missed += not abs(one.error - pinned_error(one.model, number, one.count)) <= 1e-12
        missed += one.variant != Variant(one.model) or one.mode != number
    return missed


def edges_error(phase: float) -> float:
    """How often the quietest and the fastest drive of a span that ends too soon are not at its end, or not told so."""
    from verify.waves.case import DrivenCase
    from verify.waves.operating_point import landscape

    forces = (PointForce(position=0.02), PointForce(position=0.71, amplitude=0.9, phase_deg=phase))
    beam = replace(STRIP, loss_factor=0.002)
    land = landscape(DrivenCase(beam=beam, model="analytic", count=None, forces=forces, frequency_hz=9100.0))
    wide = np.linspace(8950.0, 9250.0, 301)
    gamma = land.over(wide, np.array([phase]))[0][:, 0]
    best, wrong = float(wide[int(np.argmin(gamma))]), 0
    for low, high, end in ((best + 2.0, best + 3.0, 0), (best - 3.0, best - 2.0, -1), (best - 3.0, best + 3.0, None)):
        asked = np.linspace(low, high, 9)
        found = land.quiet_point(asked, phase)
        wrong += bool(found.note) is (end is None)
        wrong += not abs(found.frequency_hz - (best if end is None else asked[end])) <= (3.0 if end is None else 1e-9)
        wrong += (
            not abs(found.reflection - float(land.over(np.array([found.frequency_hz]), np.array([phase]))[0][0, 0]))
            <= 1e-9
        )
    near = np.linspace(best, best + 0.1, 3)
    fast = land.fast_point(near, phase, 0.9)
    wrong += not fast.note.strip() or fast.reflection > 0.9 + 1e-9 or not near[0] <= fast.frequency_hz <= near[-1]
    return float(wrong)


_row = partial(Floor, promise=0.5)
ROWS: tuple[Row, ...] = (
    _row(
        id="rules-of-a-beam",
        title="Rules of chains that stand beside the default, and all that make a difference, on nine beams",
        why="judge/variants.py: walls where an end turns, joints under tension and shear, attachments of bodies.",
        along="beam",
        at=tuple(float(n) for n in range(len(EXPECTED))),
        error=rules_error,
    ),
    _row(
        id="names-of-rules",
        title="Labels, titles, orders and remarks of models with settings",
        why="judge/variants.py: several words of a setting stand side by side.",
        along="set",
        at=(0,),
        error=words_error,
    ),
    Floor(
        id="brackets-by-dispersion",
        title="Bracket, middle and width of a pinned strip by its dispersion, and beams that have none",
        why="judge/workbench.py: segments below, elements above, to rounding.",
        along="mode",
        at=(1, 4),
        promise=1e-10,
        error=brackets_error,
    ),
    _row(
        id="sizes-side-by-side",
        title="Sizes of both models that keep 1 %, their errors and modes, against every size",
        why="judge/sizing.py: to a part.",
        along="mode",
        at=(2, 5),
        error=chosen_error,
    ),
    _row(
        id="searches-that-end",
        title="Quietest and fastest drives of a search whose span ends too soon, and whether that is said",
        why="waves/operating_point.py: at the end, with a note.",
        along="degrees",
        at=(70.0,),
        error=edges_error,
    ),
)
