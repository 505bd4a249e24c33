"""The driven beam: its table holds the quantities of the wave."""

import pytest

from verify.errors import InputError
from verify.judge.cache import SolutionCache
from verify.quantities.base import evaluate
from verify.scene.load import load_scene
from verify.studies.wave import Wave

SMALL = Wave(count=49, counts=(49, 98))


def test_ratios_equal_the_quantities(run):
    scene = load_scene("paper-wave")
    cache, table = SolutionCache(scene.beam), run("paper-wave", SMALL).tables[0]
    names = {"exact beam": "analytic", "segments": "segment", "Hermite elements": "fem"}
    assert len(table.rows) == 5
    for row in table.records():
        arguments = {"model": names[row["model"]]} | ({"count": row["N"]} if row["N"] else {})
        for name, heading in (
            ("standing_wave_ratio", "SWR"),
            ("axis_ratio", "axis ratio"),
            ("crest_speed", "crest speed"),
        ):
            expected = evaluate(f"wave.{name}", arguments, scene, cache)
            assert row[heading] == pytest.approx(expected, rel=1e-9)
        assert row["SWR there"] < row["SWR"]


def test_wave_renders(run, renders):
    axes = renders(run("paper-wave", SMALL))
    assert axes["wave-envelopes"].get_ylabel() == "amplitude, µm"
    assert len(axes["wave-ellipses"].lines) == 14


@pytest.mark.parametrize(
    ("scene", "study", "word"),
    [
        ("stepped-beam", Wave(), "wave"),
        ("paper-wave", Wave(counts=(7,)), "count"),
    ],
)
def test_refusals_name_the_field(scene, study, word):
    with pytest.raises(InputError, match=word):
        study.check(load_scene(scene))
