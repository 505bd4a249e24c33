"""The driven beam: its table holds the quantities of the wave."""

import pytest

from verify.errors import InputError
from verify.judge.cache import SolutionCache
from verify.quantities.base import evaluate
from verify.scene.load import load_scene
from verify.studies.wave import Wave, ellipses


def column(table, name):
    return [record[name] for record in table.records()]


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


def test_operating_point_lies_at_the_least_reflection(run):
    (first, second) = run("paper-wave", SMALL).tables[1].records()
    assert first["operating point"] == "least reflection"
    assert first["reflection"] < second["reflection"] <= 0.1 + 1e-9
    assert abs(second["crest speed"]) > abs(first["crest speed"])


def test_other_drive_is_stated(run):
    result = run("paper-wave", SMALL)
    assert result.data["other_drive_standing_wave_ratio"] == pytest.approx(2.5882, abs=1e-3)
    assert "displacements" in result.tables[0].notes[1]


def test_wave_renders(run, renders):
    axes = renders(run("paper-wave", SMALL))
    assert axes["wave-envelopes"].get_ylabel() == "amplitude, µm"
    assert axes["wave-sizes"].get_yscale() == "log"
    assert len(axes["wave-ellipses"].lines) == 14


def test_ellipses_have_the_height_of_the_wave():
    scene = load_scene("paper-wave")
    from verify.models.catalogue import MODELS

    field = MODELS["analytic"].solve_harmonic(scene.beam, scene.forces, scene.drive.frequency_hz, None)
    x, up, magnified, widest = ellipses(field)
    height = abs(field.deflection([0.25 * scene.beam.length])[0])
    assert abs(up[0]).max() == pytest.approx(height, rel=0.01)
    assert magnified > 1.0 > widest > 0.0
    assert all(low < high for low, high in zip(x.max(axis=1), x.min(axis=1)[1:], strict=False))


@pytest.mark.parametrize(
    ("scene", "study", "word"),
    [
        ("stepped-beam", Wave(), "wave"),
        ("paper-wave", Wave(counts=(7,)), "count"),
        ("paper-wave", Wave(model="mean"), "wave.model"),
        ("stick-slip-belt", Wave(), "two forces"),
    ],
)
def test_refusals_name_the_field(scene, study, word):
    with pytest.raises(InputError, match=word):
        study.check(load_scene(scene))


def test_column_reads_si_units(run):
    assert max(column(run("paper-wave", SMALL).tables[0], "crest speed")) < -3e-3
