"""What the judge says in words: which sizes keep an accuracy, why brackets, orders and lines of costs are none."""

from collections.abc import Callable

from verify.errors import InputError
from verify.judge.workbench import Settings
from verify.stress.judge.side_by_side import LOADED, TAUT
from verify.stress.kind import Floor, Row
from verify.stress.references.beams import STEPPED, STRIP, held

KEPT: tuple[tuple[int, tuple[int, ...], str, str], ...] = (
    (7, (5, 6, 7), "", "N = 7 do; larger ones were not solved"),
    (7, (7, 8, 9), "", "all N from 7 to 9 do; larger ones were not solved"),
    (7, (7, 8, 9, 20), "do as well", "all N from 7 to 9 do, and those tried up to 20; larger ones do as well"),
    (7, (7, 20), "", "those tried up to 20 do; larger ones were not solved"),
)
"""From which size, what does, what of larger ones; what is said."""
BRACKETS: tuple[tuple[object, Settings, str], ...] = (
    (STRIP, (), ""),
    (held("clamped", "free"), (("wall", "half"),), ""),
    (held("clamped", "free"), (), "with wall = 'gregory' at a clamped end"),
    (STEPPED, (), "on a stepped beam the chain may lie above"),
    (TAUT, (), "on a beam with beam.tension neither side is proven"),
    (LOADED, (), "on a beam with beam.mass neither side is proven"),
    (STRIP, (("theory", "rayleigh"),), "with theory = 'rayleigh' the chain may lie above"),
    (STRIP, (("grading", 1.3),), "with grading = 1.3 a chain of unequal links"),
)


def _said(ask: Callable[[], object]) -> str:
    try:
        ask()
    except InputError as error:
        return str(error)
    return ""


def _sizes_error() -> int:
    """Likewise of the sizes that keep an accuracy, tried and by the error law."""
    from verify.judge.known import by_law, kept, solved, worst_of
    from verify.judge.workbench import Workbench

    wrong = sum(
        solved(count, {4: False} | dict.fromkeys(does, True), beyond) != said for count, does, beyond, said in KEPT
    )
    bench, free = Workbench(STRIP), Workbench(held("free", "free"))
    wrong += not by_law(bench, "segment", 2, 30).startswith("every larger N does by the error law, 0.")
    wrong += "2.7% off here; smaller ones" not in by_law(Workbench(held("clamped", "clamped")), "segment", 3, 7)
    does = dict.fromkeys((30, 31), True)
    law = "do by the error law, to which those from 30 on keep within a third of its terms"
    wrong += kept(free, "segment", range(2, 3), 30, does) != law or kept(free, "segment", range(2, 3), 40, does) != ""
    wrong += worst_of(bench, "segment", range(1, 4), 12, ()) != 3 or worst_of(bench, "fem", range(2, 3), 12, ()) != 2
    return wrong


def _brackets_error() -> int:
    """Likewise of beams and models without a bracket, and of modes that a model has not."""
    from verify.judge.workbench import bracketed, check_bracket, no_such_mode

    wrong = 0
    for beam, settings, words in BRACKETS:
        said = _said(lambda: check_bracket(beam, settings))  # type: ignore[arg-type]  # noqa: B023
        wrong += said.startswith(f"mode.bracket: {words}") is not bool(words)
    clamped = held("clamped", "free")
    wrong += bracketed(clamped, ((), (("wall", "half"),))) != (("wall", "half"),)
    wrong += "gregory" not in _said(lambda: bracketed(clamped, ((), (("wall", "five-joint"),))))
    wrong += no_such_mode(9, "fem", 3, 6) != "mode = 9: the fem model at count = 3 has 6 elastic modes, raise count"
    return wrong


def _orders_error() -> int:
    """Likewise of orders that none are, and of the middle of a bracket."""
    from verify.judge.compare import bracket, observed_order, settled_order

    sizes = (10.0, 20.0, 40.0)
    asks: tuple[tuple[Callable[[], object], str], ...] = (
        (lambda: observed_order(sizes[:2], (4.0, 1.0)), "counts = [10.0, 20.0]: an observed order needs three or more"),
        (lambda: observed_order((9.0, 9.0, 3.0), (4.0, 2.0, 1.0)), "needs three or more different sizes"),
        (lambda: observed_order(sizes, (4.0, float("inf"), 1.0)), "an error that is not finite"),
        (lambda: observed_order(sizes, (4.0, -2.0, 1.0)), "the error changes sign"),
        (
            lambda: observed_order(sizes, (4e-12, 2e-13, 1e-13), "steps = 3"),
            "an error of 1.0e-13 is rounding",
        ),
        (
            lambda: settled_order(sizes, (16.0, 4.0, 3.9), 2),
            "no settled order between them (2.00, 0.04, where 2",
        ),
        (lambda: settled_order(sizes, (16.0, 4.0, 5.0)), "no settled order between them (2.00, -0.32)"),
        (lambda: bracket(3.0, 3.0), "thinner than the eigenvalue error (2e-14) allows"),
    )
    wrong = sum(words not in _said(ask) for ask, words in asks)
    middle = bracket(2.9, 3.1)
    wrong += not abs(middle.mean - 3.0) <= 1e-15 or not abs(middle.relative_width - 0.2 / 3.0) <= 1e-15
    return wrong


def judged_error(number: float) -> float:
    """How often the judge says other words of sizes, brackets and orders than what was found."""
    return float(_sizes_error() + _brackets_error() + _orders_error())


def costs_error(order: float) -> float:
    """How often lines that say nothing are not told so, by what they lack."""
    from verify.judge.crossing import Point, Stretch, Unearned, converging, observed, too_few

    def told(errors: tuple[float, ...], floor: float = 1e-30) -> str:
        points = [Point(1.0 / n, error, n) for n, error in zip((10.0, 20.0, 40.0, 80.0), errors, strict=False)]
        found = converging(points, (order, order), floor)
        return f"{found.why}: {found.remedy}" if isinstance(found, Unearned) else ""

    fine = [(n / 10.0) ** -order * 0.1 for n in (10.0, 20.0, 40.0, 80.0)]
    wrong = told(tuple(fine)) != "" or told(tuple(fine[:2])) != "2 sizes show no order: give three or more"
    wrong |= told(tuple(fine[:1])) != "one size shows no order: give three or more"
    wrong |= told((0.9, 0.8, 0.6, 0.1)) != "errors up to 90 % are no answers: give finer sizes"
    wrong |= told((0.1, 1e-13, 1e-14, 2e-14), 1e-12) != "errors down to 1.0e-14 are rounding: give coarser sizes"
    flat = told((0.1, 0.1, 0.1, 0.1))
    wrong |= flat != f"errors fall not at order {order:g} but at 0.00, 0.00, 0.00: give coarser ones"
    turned = told((0.1, -0.05, 0.04, 0.035))
    wrong |= not turned.startswith(
        f"errors fall not at order {order:g} but at a change of sign, a change of sign, 0.19"
    )
    wrong |= not turned.endswith("give finer ones")
    wrong |= not told((0.1, 0.003, -0.002, -0.004)).endswith(", -1.00: give finer ones")
    wrong |= not told((0.1, 3e-9, -2e-9, -4e-9)).endswith(", -1.00: give coarser ones")
    one, other = Point(0.1, 0.3, 1.0), Point(0.1, 0.2, 1.0)
    wrong |= observed(one, other, 0.0) is not None or too_few(2) != "2 sizes show no order"
    points = [Point(1.0 / n, error, n, 0.1 / n) for n, error in zip((10.0, 20.0, 40.0, 80.0), fine, strict=True)]
    least = converging(points, (order, order), 1e-30)
    wrong |= (
        not isinstance(least, Stretch) or least.span != (fine[-1], fine[0]) or not abs(least.spread - 0.01) <= 1e-15
    )
    return float(wrong)


ROWS: tuple[Row, ...] = (
    Floor(
        id="verdicts-in-words",
        title="What is said of sizes that keep an accuracy, of brackets that there are not, of orders that none are",
        why="judge/known.py, workbench.py, compare.py: sentence by sentence.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=judged_error,
    ),
    Floor(
        id="costs-that-say-nothing",
        title="Lines of costs of too few sizes, of rounding, of no answers and of no order, told by what they lack",
        why="judge/crossing.py: sentence by sentence.",
        along="order",
        at=(2.0, 4.0),
        promise=0.5,
        error=costs_error,
    ),
)
