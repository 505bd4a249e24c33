"""What a slider reads of its beam on the way: wider windows the farther it goes, each once, and not without end."""

import pytest

from verify.beam import Beam, PointForce, Section
from verify.errors import InputError
from verify.models import spline
from verify.motion import windows
from verify.motion.simulate import simulate
from verify.motion.stepping import Waited, slider_seconds
from verify.motion.surface import Growth, Stage, basis_of, cut, stages_from_rest
from verify.motion.windows import REACH, WIDEST, Windows
from verify.patience import patient
from verify.slider import Slider

STRIP = Beam(length=0.37, width=0.019, thickness=0.0011, youngs_modulus=68e9, density=2650.0)
PUSHED = (PointForce(position=0.011, amplitude=0.7), PointForce(position=0.351, amplitude=0.4, phase_deg=75.0))
HERTZ = 3120.0
MODES = 60
"""In 473 pieces."""


@pytest.fixture
def read(monkeypatch):
    """The tables that are read, each as (first piece, the next after its last)."""
    spans, table = [], Stage.table
    monkeypatch.setattr(Stage, "table", lambda self, *span: spans.append(span) or table(self, *span))
    return spans


def thrown(speed=120.0, duration=2.5e-3, **given):
    """A slider that goes over most of the beam, and not by what moves it."""
    rider = Slider(mass=0.011, mu=0.21, position=0.02, speed=speed, coupling="one-way")
    return simulate(STRIP, PUSHED, HERTZ, duration, model="analytic", modes=MODES, slider=rider, **given)


def stage(modes=MODES, beam=STRIP, model="analytic", count=None):
    basis = basis_of(beam, model, count, modes)
    return stages_from_rest(basis, PUSHED, 6.28 * HERTZ, 0.01, [Growth(cut(1e-3, 1e-6, 7), (1.0,))], 0.0)[0]


def test_a_slider_that_is_thrown_reads_few_wide_windows_and_goes_as_in_narrow_ones(read, monkeypatch):
    wide = thrown()
    passed = 0.3 / 0.37 * 473
    assert wide.displacement == pytest.approx(0.3, rel=0.01)
    assert len(read) <= passed / WIDEST + 6
    read.clear()
    monkeypatch.setattr(windows, "WIDEST", 1)
    assert thrown().travelled == pytest.approx(wide.travelled, rel=1e-12)
    assert len(read) > 0.4 * passed


def test_a_slider_that_stays_reads_the_pieces_beside_it_alone(read):
    thrown(speed=0.1)
    assert [last - first for first, last in read] == [1 + 2 * REACH]


def test_what_a_slider_comes_by_again_is_not_read_again(read):
    """To and fro over all of the beam: so many pieces, and those of two windows that both hold."""
    around = Windows(stage(), 0.0, lambda table: None)
    there = [0.37 * part / 400 for part in range(401)]
    for travelled in there + there[::-1] + there:
        table, edges = around.around(travelled)
        assert edges[0] <= travelled <= edges[-1]
        assert len(table) == len(edges) - 1
    assert len(set(read)) == len(read)
    assert sum(last - first for first, last in read) < 1.3 * 473


def test_what_is_kept_has_an_end(monkeypatch):
    around = Windows(stage(), 0.0, lambda table: None)
    monkeypatch.setattr(windows, "MOST_BYTES", 3_000_000)
    for part in range(401):
        table, _ = around.around(0.37 * part / 400)
        assert table.nbytes <= sum(one.nbytes for one, _ in around.kept.values()) <= 3_000_000


def test_a_slider_that_reads_ever_more_of_its_beam_is_refused_before_it_is_through(read):
    """Its steps alone would be waited for."""
    steps, reading = thrown().statistics.steps, len(read)
    assert reading > 10
    read.clear()
    with patient(slider_seconds(steps, MODES, two_way=False) + 0.1), pytest.raises(InputError) as refused:
        thrown(patient=False)
    assert str(refused.value).startswith("duration = 0.0025 takes longer than the ")
    assert "comes by ever more of the beam" in str(refused.value)
    assert 1 < len(read) < reading
    with patient(0.01):
        assert thrown(patient=True).statistics.steps == steps


def test_what_is_waited_for_are_all_runs_of_a_slider_and_what_they_read():
    waited, one = Waited(rows=37, two_way=True, duration=None), stage()
    table = one.table(3, 11)
    for _ in range(5):
        waited.read(table)
    own = slider_seconds(900, 37, two_way=True)
    assert waited.seconds(900) - own == pytest.approx(5 * windows.table_seconds(table))
    assert windows.table_seconds(one.table(3, 19)) > windows.table_seconds(table)


def test_the_line_through_unlike_links_is_made_once(monkeypatch):
    """All of it was made anew for each derivative of each window: 0.1 s of 800 links."""
    made, solve = [], spline._by_band
    monkeypatch.setattr(spline, "SMALL", 1)
    monkeypatch.setattr(spline, "_by_band", lambda *given: made.append(given) or solve(*given))
    sections = (Section(length=0.15), Section(length=0.22, thickness=0.0014))
    stepped = Beam(**{name: getattr(STRIP, name) for name in STRIP.__struct_fields__} | {"section": sections})
    one = stage(None, stepped, "segment", 23)
    for first in range(9):
        one.table(first, first + 2)
    assert len(made) <= 1
