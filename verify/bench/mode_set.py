"""Natural frequencies: segments by every rule that differs on the beam, elements, stock scikit-fem, the mean, exact."""

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from verify.bench.kind import ASKED_OF_PARTS, Case, Entry, Judged, Line, Reference, Told, orders_due
from verify.bench.request import Settled
from verify.errors import InputError
from verify.judge.compare import EIGENVALUE_FLOOR, ORDER_FLOOR, relative_error
from verify.judge.variants import Variant, every_rule, has_wall, models_with
from verify.judge.workbench import Workbench, check_bracket, no_such_mode
from verify.models.catalogue import MODELS, bounding, discrete
from verify.models.eigen import solve_seconds
from verify.models.modes import Modes
from verify.models.naming import MEAN
from verify.options import WALLS

if TYPE_CHECKING:
    from verify.beam import Beam
    from verify.scenes.scene import Scene

STOCK, MEAN_OF_BOTH, EXACT = "stock scikit-fem", "mean of both", "exact"
OVERHEAD_S = 2e-3
"""Of a solve, beside what its size takes."""
CLOSED_FORM = 9e-16
"""Relative: four roundings of a frequency in closed form."""
COUNTED = EIGENVALUE_FLOOR
"""Relative: roots of the exact characteristic equation are found to about so much."""


def mode_cases(scene: "Scene", its: Settled, bench: Workbench) -> Iterator[Case]:
    """One for each mode."""
    from verify.bench.peer_set import frequency_entries

    able = discrete("solve_modes", scene.beam)
    variants = (*(Variant(model.name) for model in able), *every_rule(scene.beam))
    beside, why_not = _beside(scene.beam, its)
    refused = [f"{m.title} takes no part: {why}" for m in discrete("solve_modes") if (why := m.refuses(scene.beam))]
    why_not += _walls_without(scene.beam, variants, its)
    for mode in its.modes:
        theirs, absent = frequency_entries(scene, its, mode) if its.peers else ((), ())
        entries = [_variant_entry(scene.beam, one, n, mode) for one in variants for n in its.counts]
        entries += [make(scene.beam, n, mode) for make in beside for n in its.counts]
        entries += [*theirs, _exact_entry(scene.beam, mode)]
        yield Case(
            set="modes",
            about=f"mode {mode}",
            question="frequency",
            condition="a warm solve from beam to modes",
            entries=tuple(entries),
            pairs=(
                *_pairs({entry.line.name: None for entry in entries}, [one.title for one in variants]),
                *((bounding()[0].title, name) for name in dict.fromkeys(entry.line.name for entry in theirs)),
            ),
            judge=_judge(bench, mode),
            floor=ORDER_FLOOR,
            wanted=ASKED_OF_PARTS,
            notes=(*refused, *why_not, *absent),
        )


def _pairs(lines: dict[str, None], variants: list[str]) -> tuple[tuple[str, str], ...]:
    """Segments against elements, each rule against the default, the mean and stock elements against ours."""
    chain, elements = (model.title for model in bounding())
    wanted = [(chain, elements), (elements, STOCK), (chain, MEAN_OF_BOTH)]
    wanted += [(chain, title) for title in variants if title not in (chain, elements)]
    return tuple(pair for pair in dict.fromkeys(wanted) if pair[0] in lines and pair[1] in lines)


def _line(beam: "Beam", one: Variant) -> Line:
    how = dict(one.settings)
    return Line(name=one.title, model=one.model, orders=orders_due(MODELS[one.model], beam, **how), settings=how)


def _variant_entry(beam: "Beam", one: Variant, count: int, mode: int) -> Entry:
    model, how = MODELS[one.model], dict(one.settings)

    def run() -> Told:
        return Told(model.solve_modes(beam, mode, count, **how))

    def prepare() -> Callable[[], Told]:
        if (most := model.n_elastic(beam, count, **how)) < mode:
            raise InputError(no_such_mode(mode, one.model, count, most))
        return run

    seconds = OVERHEAD_S + solve_seconds(model.unknowns(beam, count, **how), mode)
    return Entry(line=_line(beam, one), size=1 / count, count=count, estimate_s=seconds, prepare=prepare, afresh=True)


def _walls_without(beam: "Beam", variants: Sequence[Variant], its: Settled) -> Iterator[str]:
    """Why a wall takes no part on a beam that has one."""
    for one in (Variant(name, (("wall", wall),)) for name in models_with("wall") for wall in WALLS[1:]):
        if has_wall(beam) and one not in variants:
            try:
                MODELS[one.model].check(beam, 1, max(its.counts), **dict(one.settings))
            except InputError as error:
                yield f"{one.title} takes no part: {error}"


def _beside(beam: "Beam", its: Settled) -> tuple[list[Callable[["Beam", int, int], Entry]], list[str]]:
    """Makers of entries of stock scikit-fem and of the mean, and why one of them takes no part."""
    from verify.elements.stock import check_stock

    makers: list[Callable[[Beam, int, int], Entry]] = []
    why = []
    try:
        check_stock(beam, 1, max(its.counts))
        makers.append(_stock_entry)
    except InputError as error:
        why.append(f"{STOCK} takes no part: {error}")
    try:
        check_bracket(beam, ())
        makers.append(_mean_entry)
    except InputError as error:
        why.append(f"the {MEAN_OF_BOTH} takes no part: {error}")
    return makers, why


def _stock_entry(beam: "Beam", count: int, mode: int) -> Entry:
    from verify.elements.stock import check_stock, stock_frequency_hz

    def prepare() -> Callable[[], Told]:
        check_stock(beam, mode, count)
        return lambda: Told(stock_frequency_hz(beam, mode, count))

    line = Line(name=STOCK, orders=(4.0, 4.0))
    seconds = 5.0 * OVERHEAD_S + solve_seconds(2 * count, mode)
    return Entry(line=line, size=1.0 / count, count=count, estimate_s=seconds, prepare=prepare)


def _mean_entry(beam: "Beam", count: int, mode: int) -> Entry:
    """Of segments below and elements above: both are solved."""
    models = bounding()

    def prepare() -> Callable[[], Told]:
        Workbench(beam).bracket(mode, count)  # raises where rounding is wider than the bracket
        return lambda: Told(float(sum(m.solve_modes(beam, mode, count).frequencies_hz[mode - 1] for m in models)) / 2.0)

    seconds = sum(OVERHEAD_S + solve_seconds(model.unknowns(beam, count), mode) for model in models)
    line = Line(name=MEAN_OF_BOTH, model=MEAN, orders=(6.0, 6.0))
    return Entry(line=line, size=1.0 / count, count=count, estimate_s=seconds, prepare=prepare, afresh=True)


def _exact_entry(beam: "Beam", mode: int) -> Entry:
    """In closed form where there is one, else the root of the characteristic equation."""
    from verify.exact.closed_forms import frequency_hz
    from verify.exact.modes import exact_frequency_hz

    solve = frequency_hz if beam.uniform else exact_frequency_hz
    return Entry(
        line=Line(name=EXACT, model="analytic"),
        size=0.0,
        estimate_s=OVERHEAD_S,
        prepare=lambda: lambda: Told(solve(beam, mode)),
        afresh=not beam.uniform,
    )


def _judge(bench: Workbench, mode: int) -> Callable[[], Callable[[Entry, Any], Judged]]:
    def judge() -> Callable[[Entry, Any], Judged]:
        exact = bench.exact_hz(mode)
        closed = bench.beam.uniform
        reference = Reference(
            "exact frequency in closed form, to rounding" if closed else "root of the exact characteristic equation",
            CLOSED_FORM if closed else COUNTED,
        )

        def error(entry: Entry, answer: Any) -> Judged:
            if isinstance(answer, Modes):
                value = _paired(bench, entry, answer, mode)
            else:
                value = float(answer[mode - 1] if isinstance(answer, np.ndarray) else answer)
            return Judged(relative_error(value, exact), reference)

        return error

    return judge


def _paired(bench: Workbench, entry: Entry, modes: Modes, mode: int) -> float:
    """Of the computed mode with the shape of the exact one. Raises PairingError."""
    assert entry.count is not None
    settings = tuple(entry.line.settings.items())
    return float(modes.frequencies_hz[bench.paired_index(entry.line.model, entry.count, mode, settings)])
