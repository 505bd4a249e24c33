"""The map of a driven beam: phases lie between the forces, and what is cut off is told as such."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify import load_scene
from verify.judge.workbench import Workbench
from verify.report.plots import _map_words
from verify.studies.chart import Map
from verify.studies.wave.charts import CLIPPED, wave_charts
from verify.studies.wave.figures import wave_study

FIRST = 17.0


def studied(*more):
    scene = load_scene(
        "paper-wave",
        (
            'wave.model="analytic"',
            "wave.counts=[49]",
            "wave.frequency_hz=[4100.0, 4400.0, 4]",
            "wave.phase_deg=[30.0, 75.0, 4]",
            *more,
        ),
    )
    return wave_study(scene, Workbench(scene.beam), scene.wave)


def test_phases_of_the_map_are_told_from_the_first_force_whatever_its_own():
    """Both forces turned alike make the same map."""
    alone = studied()
    turned = studied(f"drive.force.0.phase_deg={FIRST}", f"drive.force.1.phase_deg={90.0 + FIRST}")
    assert turned.map.axes[1].values == pytest.approx(FIRST + np.linspace(30.0, 75.0, 4))
    assert turned.map.values == pytest.approx(alone.map.values, rel=1e-9)
    maps = [next(chart.map for chart in wave_charts(one) if chart.map) for one in (alone, turned)]
    assert maps[0].y == pytest.approx([30.0, 45.0, 60.0, 75.0])
    assert maps[1].y == pytest.approx(maps[0].y)


def test_a_value_that_stands_for_larger_ones_is_told_as_that_or_more():
    study = studied()
    chart = next(one for one in wave_charts(study) if one.map)
    assert chart.map.most == CLIPPED
    rows = ((2.5, 7.0, 7.0), (7.0, 3.5, 4.0))
    cut = Map(name="ratio", x=(1.0, 2.0, 2.5), y=(3.0, 5.0), values=rows, most=7.0)
    assert "The least ratio is 2.5, at" in _map_words(cut, chart)
    assert "The ratio is 7 or more at 3 of 6 points;" in _map_words(cut, chart)
    assert "largest" not in _map_words(cut, chart)  # which of the three it is, is cut off
    whole = replace(cut, most=None)
    assert "The largest ratio is 7, at" in _map_words(whole, chart)
    assert "or more" not in _map_words(whole, chart)
