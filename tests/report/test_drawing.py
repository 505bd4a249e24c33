"""The drawing of a beam names everything that is there."""

import re

import pytest

from verify.report.beam_drawing import beam_figure
from verify.report.plotting import figure_svg
from verify.scene.load import scene_from
from verify.scene.model import Scene

SECTION = {"width": 0.017, "thickness": 0.0023, "youngs_modulus": 71e9, "density": 2710.0}


def texts(scene, width=8.4):
    return re.findall(r"<text[^>]*>([^<]*)</text>", figure_svg(beam_figure(scene, width)))


def scene_of(**tables) -> Scene:
    beam = {"length": 0.61, **SECTION, "supports": ["free", "guided"]} | tables.pop("beam", {})
    return scene_from({"name": "drawn", "beam": beam, **tables})


@pytest.mark.parametrize("width", [8.4, 4.2])
def test_everything_is_named(width):
    scene = scene_of(
        beam={
            "tension": 43.0,
            "foundation": 310.0,
            "mass": [{"position": 0.1, "mass": 0.021, "rotary_inertia": 3e-6}],
            "spring": [{"position": 0.3, "stiffness": 1700.0, "rotational": 2.5}],
        },
        drive={
            "frequency_hz": 137.0,
            "force": [{"position": 0.1, "amplitude": 1.3, "phase_deg": 29.0}],
            "device": [{"position": 0.5, "dashpot": 0.7}],
        },
        slider={"mass": 0.0031, "mu": 0.23, "position": 0.42},
    )
    words = " ".join(texts(scene, width))
    for part in (
        "free",
        "guided",
        "0.021 kg",
        "3e-06 kg m²",
        "1700 N/m",
        "2.5 N m/rad",
        "43 N",
        "310 N/m²",
        "0.7 N s/m",
    ):
        assert part in words
    for part in ("x = 100 mm", "1.3 N, 29°", "137 Hz", "slider 3.1 g, μ = 0.23", "17 mm × 2.3 mm"):
        assert part in words


def test_caption_counts_parts():
    scene = scene_of(beam={"supports": ["clamped", "pinned"], "mass": [{"position": 0.2, "mass": 0.1}]})
    assert beam_figure(scene).caption == "610 mm long, clamped at the left, pinned at the right, mass: 1."


def test_text_does_not_overlap():
    forces = [{"position": 0.2 + 0.004 * i, "amplitude": 1.0 + i} for i in range(5)]
    svg = figure_svg(beam_figure(scene_of(drive={"frequency_hz": 90.0, "force": forces})))
    places = [(float(x), float(y)) for x, y in re.findall(r'<text [^>]*?x="([\d.]+)" y="([\d.]+)"', svg)]
    assert len(places) == len(set(places)) >= 10
    for i, (x, y) in enumerate(places):
        assert all(abs(x - u) > 15.0 or abs(y - v) > 8.0 for u, v in places[:i])
