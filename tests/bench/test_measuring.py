"""Rows from runs whose clock is known: medians, spreads, set-ups, what does not fit, who breaks."""

from dataclasses import dataclass, field

import msgspec
import pytest

from verify.bench.kind import Case, Entry, Judged, Line, Reference, Told
from verify.bench.measuring import fitting, measured
from verify.bench.sentences import sentences_of
from verify.errors import InputError


@dataclass
class Clock:
    """Seconds that runs say they took."""

    now: float = 0.0
    turns: dict = field(default_factory=dict)

    def __call__(self):
        return self.now

    def run(self, name, seconds):
        """The seconds of the next turn; given as a list they go round."""
        i = self.turns[name] = self.turns.get(name, -1) + 1
        self.now += seconds[i % len(seconds)]


EXACT = 2.5


def entry(clock, name, count, *, seconds=(1.0,), answer=None, set_up=0.0, estimate=0.1, orders=(4.0, 4.0), refuses=""):
    def run():
        if refuses:
            raise InputError(refuses)
        clock.run((name, count), seconds)
        return Told(EXACT * (1.0 + 7.0 * count**-4.0) if answer is None else answer)

    def prepare():
        clock.now += set_up
        return run

    line = Line(name=name, orders=orders, model="" if orders else "analytic")
    return Entry(
        line=line,
        size=1 / count if count else 0.0,
        count=count,
        estimate_s=estimate,
        prepare=prepare,
        sets_up=bool(set_up),
    )


def case(*entries, uncertainty=1e-15, **more):
    def judge():
        return lambda entry, answer: Judged(answer / EXACT - 1.0, Reference("two and a half", uncertainty))

    given = {"set": "modes", "about": "mode 3", "question": "frequency", "condition": "at once", "pairs": ()}
    return Case(**given | {"entries": entries, "judge": judge} | more)


def test_a_row_holds_the_median_of_its_rounds_and_what_lies_between_their_quartiles():
    clock = Clock()
    rounds = [9.0, 9.0, 1.0, 2.0, 3.0, 4.0, 50.0]  # the first two calls are no rounds
    one = case(entry(clock, "a", 20, seconds=rounds, set_up=0.25), entry(clock, "b", 20, seconds=(0.5,)))
    (a, b) = (found.row for found in measured(one, {}, 5, 1e9, clock))
    assert (a.warm_s, a.spread_s, a.set_up_s, a.first_s, a.rounds) == (3.0, 2.0, 0.25, 9.25, 5)
    assert (b.warm_s, b.spread_s, b.set_up_s) == (0.5, 0.0, None)


def test_rounds_end_where_the_time_is_spent_but_not_before_three():
    clock = Clock()
    (found,) = measured(case(entry(clock, "a", 20, seconds=(10.0,))), {}, 9, 25.0, clock)
    assert found.row.rounds == 3
    (found,) = measured(case(entry(clock, "a", 20, seconds=(10.0,))), {}, 9, 55.0, clock)
    assert found.row.rounds == 6


def test_methods_take_turns():
    clock, told = Clock(), []
    original = clock.run
    clock.run = lambda name, seconds: (told.append(name[0]), original(name, seconds))
    measured(case(entry(clock, "a", 20), entry(clock, "b", 20)), {}, 3, 1e9, clock)
    assert told == ["a", "a", "b", "b", "a", "b", "a", "b", "a", "b"]


def test_orders_are_observed_from_the_coarser_row():
    clock = Clock()
    rows = [f.row for f in measured(case(*(entry(clock, "a", n) for n in (10, 20, 50))), {}, 3, 1e9, clock)]
    assert [row.order for row in rows] == [None, pytest.approx(4.0, abs=1e-6), pytest.approx(4.0, abs=1e-6)]


def test_a_method_whose_result_is_wrong_is_seen():
    clock = Clock()
    good, bad = case(entry(clock, "a", 20)), case(entry(clock, "a", 20, answer=EXACT * 1.01))
    right, wrong = (measured(one, {}, 3, 1e9, clock)[0].row.error for one in (good, bad))
    assert right == pytest.approx(7.0 / 20**4, rel=1e-9)
    assert wrong == pytest.approx(0.01, rel=1e-9)


def test_a_method_that_refuses_or_breaks_is_named_and_the_others_go_on():
    clock = Clock()
    one = case(
        entry(clock, "a", 20),
        entry(clock, "b", 20, refuses="b broke: silent reset at t = 1.3 ms"),
        entry(clock, "c", 20, answer=float("nan")),
    )
    a, b, c = (found.row for found in measured(one, {}, 3, 1e9, clock))
    assert a.rounds == 3
    assert (b.left_out, b.error, b.warm_s) == ("b broke: silent reset at t = 1.3 ms", None, None)
    assert "no finite figure" in c.left_out


def test_what_does_not_fit_is_left_out_the_largest_first_and_named():
    clock = Clock()
    sizes = (20, 40, 80, 160)
    one = case(*(entry(clock, "a", n, estimate=n / 100) for n in sizes))
    why, left = fitting([one], 9.0)
    assert left == pytest.approx(6 * (0.2 + 0.4 + 0.8))
    rows = [found.row for found in measured(one, why, 3, 1e9, clock)]
    assert [row.count for row in rows if row.left_out] == [160]
    assert "about 9.6 s of work" in rows[-1].left_out
    assert "a, N = 160" in rows[-1].left_out
    why, left = fitting([one], 1.0)
    assert (len(why), left) == (4, pytest.approx(0.0, abs=1e-12))


def test_a_case_whose_reference_alone_takes_too_long_does_not_push_another_out():
    clock = Clock()
    cheap = case(entry(clock, "a", 20, estimate=0.5))
    dear = msgspec.structs.replace(case(entry(clock, "b", 20, estimate=0.1)), estimate_s=300.0)
    why, left = fitting([cheap, dear], 30.0)
    assert list(why) == [id(dear.entries[0])]
    assert left == pytest.approx(6 * 0.5 + cheap.estimate_s)
    assert "with its reference, which takes 3e+02" in why[id(dear.entries[0])]


def test_a_reference_is_not_solved_where_nothing_is_left_of_its_case():
    def judge():
        raise AssertionError

    one = case(entry(Clock(), "a", 20, estimate=1.0), judge=judge, estimate_s=3.0)
    why, left = fitting([one], 5.0)
    assert left == 0.0
    assert measured(one, why, 3, 1e9)[0].row.left_out


def compared(a, b, set_up=0.0, **more):
    """The sentence of two methods over four sizes, each (seconds at N = 10, growth with N, answers)."""
    clock = Clock()
    entries = [
        entry(clock, name, n, seconds=(seconds * (n / 10) ** growth,), answer=answers and answers(n), set_up=set_up)
        for name, (seconds, growth, answers) in (("a", a), ("b", b))
        for n in (10, 20, 40, 80)
    ]
    one = case(*entries, pairs=(("a", "b"),), **more)
    return sentences_of(one, measured(one, {}, 3, 1e9, clock), "own-scene")[0]


def test_a_sentence_names_the_crossing_where_both_converge():
    """One costs 0.05 s and N, b 0.02 s and N^2 at the same error: b is cheaper up to N = 25, an error of 7 / 25^4."""
    told = compared((0.05, 1.0, None), (0.02, 2.0, None))
    assert told.earned
    assert told.crossing == pytest.approx(7.0 / 25**4, rel=1e-3)
    assert told.ratio == pytest.approx(0.4 * 8, rel=1e-9)
    assert "b above, a below" in told.text
    assert "own-scene, frequency; at once" in told.text


@pytest.mark.parametrize(
    ("a", "b", "said"),
    [
        (
            (0.05, 1.0),
            (0.02, 1.0),
            "takes 2.50 times as long by a as by b; 2.50 at 0.03 %; runs without their set-up 2.50 at",
        ),
        (
            (0.02, 1.0),
            (0.05, 1.0),
            "takes 2.50 times as long by b as by a; 2.50 at 0.03 %; runs without their set-up 2.50 at",
        ),
        (
            (0.05, 1.0),
            (0.02, 2.0),
            "; 2.02 times as long by a at 0.03 %; runs without their set-up 3.20 times as long by b at",
        ),
    ],
)
def test_ratios_within_a_sentence_go_the_way_that_its_verdict_says(a, b, said):
    """Costs of a s (N / 10)^p, N = 12.36 at an error of 3e-4 and 80 at the smallest."""
    assert said in compared((*a, None), (*b, None), set_up=1e-9, wanted=(3e-4,)).text


@pytest.mark.parametrize(
    ("times", "said"),
    [
        ((2.0, 0.5, 0.5, 2.0), "0.017 %, 6.8e-05 %: a above, b between, a below; 2.00 times as long by b at 1.7e-05 %"),
        ((0.5, 2.0, 2.0, 0.95), "0.017 %: b above, a below; 1.05 times as long by a at 1.7e-05 %"),
    ],
)
def test_a_sentence_names_the_cheaper_one_on_either_side_of_every_crossing(times, said):
    """Of b over those of a, which take a second: in the second case its last lies within the spread of 6 %."""
    clock = Clock()
    rounds = (0.97, 1.0, 1.03)
    entries = [
        entry(clock, name, n, seconds=[part * s for part in rounds])
        for name, each in (("a", (1.0,) * 4), ("b", times))
        for n, s in zip((10, 20, 40, 80), each, strict=True)
    ]
    one = case(*entries, pairs=(("a", "b"),))
    (told,) = sentences_of(one, measured(one, {}, 3, 1e9, clock), "own-scene")
    assert f"changes at an error of {said}" in told.text


def test_a_sentence_is_withheld_where_errors_do_not_converge_and_says_why():
    told = compared((0.05, 1.0, None), (0.02, 2.0, lambda n: EXACT * (1.0 + 0.03 / n)))
    assert (told.earned, told.crossing, told.ratio) == (False, None, None)
    assert "b: errors fall not at order 4 but at 1.00, 1.00, 1.00; give finer ones" in told.text


def test_at_errors_that_are_asked_for_times_are_told_of_methods_that_converge_at_no_known_order():
    """One of them, b, is of order 1: within 1 % from N = 3 on and so as coarse as it goes, within 0.1 % from 40 on; a at once."""
    told = compared((0.05, 1.0, None), (0.02, 2.0, lambda n: EXACT * (1.0 + 0.03 / n)), wanted=(1e-2, 1e-3, 1e-5))
    assert not told.earned
    assert told.at == ((1e-2, pytest.approx(0.4)), (1e-3, pytest.approx(0.4 * 4**2)))
    assert "at 1 % 2.50 times as long by a, at 0.1 % 6.40 times as long by b, each at the coarsest" in told.text
    assert "not told, b: errors fall not at order 4 but at 1.00, 1.00, 1.00; give finer ones" in told.text
    alike = compared((0.05, 1.0, None), (0.05, 1.0, lambda n: EXACT * (1.0 + 0.003 / n)), wanted=(1e-2, 1e-3))
    assert "at 1 % and 0.1 % as long by either within the spread of 0 %" in alike.text
    exact = compared((0.05, 1.0, None), (0.02, 2.0, None), wanted=(7.0 / 25**4, 1e-2))
    assert exact.at == ((7.0 / 25**4, pytest.approx(1.0, rel=1e-3)),)  # 1 % lies beyond what both were run at


def test_no_sentence_is_made_of_a_time_that_the_clock_does_not_resolve():
    told = compared((0.05, 1.0, None), (0.0, 1.0, None))
    assert not told.earned
    assert "b: its time is below the resolution of the clock" in told.text
    for seconds, n_told in ((0.4, 1), (0.0, 0)):
        clock = Clock()
        exact = entry(clock, "exact", None, seconds=(seconds,), answer=EXACT, orders=None)
        parts = [entry(clock, "a", n, seconds=(0.1,)) for n in (10, 20)]
        one = case(*parts, exact)
        assert len(sentences_of(one, measured(one, {}, 3, 1e9, clock), "own-scene")) == n_told
        one = case(*(entry(clock, name, n, seconds=(0.1 if name == "a" else seconds,)) for name in "ab" for n in (10, 20)),
                   races=(("a", "b"),), wanted=(1e-3,))  # fmt: skip
        (raced,) = sentences_of(one, measured(one, {}, 3, 1e9, clock), "own-scene")
        assert raced.earned == bool(n_told)


def test_errors_that_the_reference_does_not_know_earn_nothing():
    assert compared((0.05, 1.0, None), (0.02, 2.0, None), uncertainty=1e-9).earned
    told = compared((0.05, 1.0, None), (0.02, 2.0, None), uncertainty=2e-5)
    assert not told.earned
    assert "rounding" in told.text


def test_a_race_that_is_not_run_says_what_is_known_and_what_was_reached_in_digits_that_tell_why():
    """Answers of N = 80 are 1.709e-7 off, which is more than 1.7e-7, and what they are against is known to 4.1e-8."""
    clock = Clock()
    entries = [entry(clock, name, n) for name in "ab" for n in (20, 80)]
    one = case(*entries, races=(("a", "b"),), wanted=(1.7e-7, 1e-7), uncertainty=4.1e-8)
    (told,) = sentences_of(one, measured(one, {}, 3, 1e9, clock), "own-scene")
    assert "at 1.7e-05 % nothing is said, a comes to 1.71e-05 %" in told.text
    assert "at 1e-05 % nothing is said, what a is held against is known to 4.1e-06 % alone" in told.text


def beside_exact(*sizes, seconds=(5.8e-6, 7e-6, 9e-6)):
    """What is said of segments of these sizes beside the exact solution, which takes 1.93 s."""
    clock = Clock()
    exact = entry(clock, "exact", None, seconds=(1.93,), answer=EXACT, orders=None)
    one = case(*(entry(clock, "a", n, seconds=(s,)) for n, s in zip(sizes, seconds, strict=False)), exact)
    (told,) = sentences_of(one, measured(one, {}, 3, 1e9, clock), "own-scene")
    return told


def test_the_time_of_the_exact_solution_has_a_unit_that_suits_it():
    told = beside_exact(20, 40, 80)
    assert "the exact solution takes 1.93 s, the cheapest of parts within 1 %, a, N = 20, 5.8 µs: " in told.text
    assert told.earned
    assert told.ratio == pytest.approx(5.8e-6 / 1.93, rel=1e-6)


def test_parts_of_one_size_are_not_called_the_cheapest_beside_the_exact_solution():
    """A hundred thousand links are within 1 % too, and take a hundred thousand times as long."""
    told = beside_exact(20)
    assert told.text == (
        "modes, mode 3: no time is set beside the exact solution's, a: one size shows no order; give three or more"
    )
    assert not told.earned
    assert told.ratio is None


def test_as_long_within_the_spread_is_no_ratio_of_the_exact_solution():
    told = beside_exact(20, 40, 80, seconds=(1.93, 2.5, 3.9))
    assert "as long by either within the spread" in told.text


@pytest.mark.parametrize(("seconds", "said"), [(3.1e-6, True), (6.4e-6, False)])
def test_what_is_cheaper_and_as_near_at_no_order_is_named_beside_the_cheapest_whose_errors_converge(seconds, said):
    clock = Clock()
    exact = entry(clock, "exact", None, seconds=(1.93,), answer=EXACT, orders=None)
    parts = [entry(clock, "a", n, seconds=(s,)) for n, s in ((20, 5.8e-6), (40, 7e-6), (80, 9e-6))]
    one = case(*parts, entry(clock, "b", 31, seconds=(seconds,)), exact)
    (told,) = sentences_of(one, measured(one, {}, 3, 1e9, clock), "own-scene")
    assert told.earned
    assert told.ratio == pytest.approx(5.8e-6 / 1.93, rel=1e-6)
    assert ("the cheapest of parts within 1 % whose errors converge over these sizes, a, N = 20" in told.text) == said
    assert ("; b, N = 31, is within it in 3.1 µs: one size shows no order" in told.text) == said
