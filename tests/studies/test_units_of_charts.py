"""What is drawn and told is in units that suit the beam: a beam a thousand times as large has the same pictures."""

import re

import numpy as np
import pytest
from msgspec.structs import replace

from verify.attached import PointMass
from verify.pictures.drawn import picture_of
from verify.pictures.rows import Asked
from verify.report.beam_drawing import NARROW, beam_drawing
from verify.run.runner import workbench_for
from verify.scenes.checked import checked
from verify.scenes.scene import scene_type
from verify.scenes.sections import SECTIONS
from verify.studies.axial_inertia.figures import axial_study
from verify.studies.told import Column, Table
from verify.units import Unit, in_words, time_in_words, unit_of, unit_over

UP = {"a": "f", "f": "p", "p": "n", "n": "µ", "µ": "m", "m": "", "": "k", "k": "M", "M": "G"}
SCALE = 1000.0
POWERS = {"m": 1, "s": 1, "g": 3, "N": 2, "W": 2, "J": 3}
"""Of the scale, by which a figure in this unit grows where strains, modulus and density stay."""


def scene_of(s, **more):
    """A pinned strip of brass, all of whose lengths and times are s times as large, its strains the same."""
    beam = {"length": 0.37 * s, "width": 0.013 * s, "thickness": 0.0011 * s}
    forces = [
        {"position": 0.021 * s, "amplitude": 2.3 * s**2, "phase_deg": 15.0},
        {"position": 0.34 * s, "amplitude": 1.9 * s**2, "phase_deg": 98.0},
    ]
    plain = {
        "name": "scaled",
        "title": "A strip of brass",
        "beam": beam | {"youngs_modulus": 105e9, "density": 8500.0},
        "drive": {"frequency_hz": 1130.0 / s, "force": forces},
    }
    return checked(plain | more, scene_type())


def wave(s):
    return scene_of(s, wave={"count": 23, "counts": [23, 29]})


def slider(s):
    own = {"mass": 2.1e-3 * s**3, "mu": 0.23, "slope": 700.0, "gravity": 0.0, "preload": 0.031 * s**2}
    motion = {"duration": 2.3e-3 * s, "count": 13, "counts": [13, 17], "steps_per_period": 32}
    return scene_of(s, slider=own | {"normal": "massless", "coupling": "one-way"}, motion=motion)


def axial(s):
    forces = [1.7 * s**2, 5.3 * s**2]
    return scene_of(s, axial_inertia={"count": 11, "forces": forces, "shown": forces[1], "duration": 2.1e-3 * s})


def methods(s):
    force = {"position": 0.021 * s, "amplitude": 2.3 * s**2}
    device = {"position": 0.34 * s, "dashpot": 9.0 * s**2, "stiffness": 5e4 * s}
    asked = {"count": 29, "span_hz": 40.0 / s, "steps": 5, "load_mass": [1.3e-7 * s**3, 2.1e-6 * s**3]}
    asked |= {"load_dashpot": [1.1 * s**2]}
    drive = {"frequency_hz": 1130.0 / s, "force": [force], "device": [device]}
    return scene_of(s, drive=drive, methods=asked)


def motor(s):
    feet = [{"length": 0.027 * s, "points": 3, "face": face} for face in ("upper", "lower")]
    own = {"mass": 0.011 * s**3, "mu": 0.21, "law": "coulomb", "gravity": 0.0, "preload": 0.17 * s**2}
    own |= {"coupling": "one-way", "foot": feet, "contact": {"stiffness": 4.1e4 * s, "damping": 0.9 * s**2}}
    asked = {"models": ["segment", "chain"], "count": 21, "speeds": 2, "periods": 20, "chain": 2e-3 * s, "places": 2}
    return scene_of(s, slider=own, motor=asked | {"chain_force": 11.0 * s**2})


MADE = {"wave": wave, "motion": slider, "axial_inertia": axial, "methods": methods, "motor": motor}


def found_of(name, s):
    scene = MADE[name](s)
    study = SECTIONS[name]
    return study.run(study.asked(scene), scene, workbench_for(scene), {}, lambda step: None)


@pytest.fixture(scope="module", params=MADE)
def pair(request):
    """A study of the strip, and of the one of a thousand times its size."""
    return found_of(request.param, 1.0), found_of(request.param, SCALE)


def grown(words):
    """An axis or a head as it is of the larger beam: its prefix a thousand times as large for each power of the scale."""

    def of(match):
        prefix, unit = match.groups()
        for _ in range(POWERS[unit]):
            prefix = UP[prefix]
        return f", {prefix}{unit}"

    return re.sub(r", ([afpnµmkM]?)([msgNWJ])$", of, words)


TIMED = {"slider-work", "slider-split"}
"""Charts of run times and of rounding."""


def test_charts_of_a_larger_beam_are_the_same_in_larger_units(pair):
    small, large = ({chart.id: chart for chart in found.charts()} for found in pair)
    assert small.keys() == large.keys()
    for name in small.keys() - TIMED:
        one, other = small[name], large[name]
        if one.x.title not in ("frequency, Hz", "force, N", "mass, mg"):
            assert other.x.title == grown(one.x.title), name
            for a, b in zip(one.lines, other.lines, strict=True):
                np.testing.assert_allclose(np.array(b.x, float), np.array(a.x, float), 1e-6, 1e-9, err_msg=name)
        assert other.y.title == grown(one.y.title), name


def test_no_chart_of_a_length_or_a_time_has_numbers_beyond_three_digits(pair):
    for found in pair:
        for chart in found.charts():
            for axis, of in ((chart.x, "x"), (chart.y, "y")):
                if not re.search(r", [afpnµmkM]?[ms]$", axis.title) or axis.log:
                    continue
                rows = [getattr(line, of) for line in chart.lines]
                rows += [row for line in chart.lines for row in (line.moves if of == "y" else line.shifts)]
                largest = max(abs(v) for row in rows for v in row if v is not None)
                assert 0.3 < largest < 3000.0, (chart.id, axis.title)


def test_tables_of_a_larger_beam_have_the_same_numbers_in_larger_units(pair):
    for one, other in zip(pair[0].tables(), pair[1].tables(), strict=True):
        for i, (a, b) in enumerate(zip(one.columns, other.columns, strict=True)):
            if not re.search(r", [afpnµmkM]?[msgNWJ]$", a.head) or a.head == "force, N":
                continue
            assert b.head.replace(" s,", " ms,") == grown(a.head)
            for row, larger in zip(one.rows, other.rows, strict=True):
                if row[i] is not None:
                    assert b.factor * larger[i] == pytest.approx(a.factor * row[i], rel=1e-3, abs=1e-3)


def test_the_bent_chain_and_the_shapes_are_in_the_units_of_the_beam():
    scene = axial(SCALE)
    movie = next(c for c in axial_study(scene, scene.axial_inertia).charts() if c.id == "chain-bending")
    assert (movie.x.title, movie.y.title) == ("x, m", "y, m")
    assert max(movie.lines[0].moves[0]) < 370.0
    spectrum = scene_of(4e-5 / 0.37, spectrum={"modes": 3})
    study = SECTIONS["spectrum"]
    charts = study.run(spectrum.spectrum, spectrum, workbench_for(spectrum), {}, lambda step: None).charts()
    shapes = next(chart for chart in charts if chart.id == "mode-shapes")
    assert shapes.x.title == "x, µm"
    assert shapes.lines[0].x[-1] == pytest.approx(40.0)
    rounded = scene_of(1.0 / 0.37, spectrum={"modes": 3, "count": 49})  # 49 parts end at 1 - 1e-16
    charts = study.run(rounded.spectrum, rounded, workbench_for(rounded), {}, lambda step: None).charts()
    shapes = next(chart for chart in charts if chart.id == "mode-shapes")
    assert shapes.x.title == "x, m"
    assert [line.x[-1] for line in shapes.lines] == pytest.approx([1.0] * len(shapes.lines))


def test_pictures_and_drawings_tell_their_lengths_in_units_that_suit():
    scene = slider(2e-5)
    assert "7.4 µm" in beam_drawing(scene)
    picture = picture_of(scene, Asked(what="wave", mode=None, count=13, moving=False))
    assert re.fullmatch(r"-[\d.]+ pm", picture.scale[0])


@pytest.mark.parametrize(
    ("size", "unit"),
    [(3000.0, "km"), (1.0, "m"), (0.999, "mm"), (4e-5, "µm"), (7.1e-8, "nm"), (3e-19, "am"), (2e7, "km"), (0.0, "m")],
)
def test_a_length_has_the_unit_in_which_it_is_at_least_one(size, unit):
    assert unit_of(size).name == unit
    assert unit_of(-size) == unit_of(size)


def test_a_unit_is_chosen_by_the_largest_and_gaps_are_not_asked():
    assert unit_over([None, 3e-5, float("nan"), -0.02]) == Unit("mm", 1e3)
    assert unit_over([None]) == Unit("m", 1.0)


def test_words_carry_the_unit_in_which_they_are_written():
    assert in_words(0.99996) == "1 m"
    assert in_words(-3.2e4, "N", "+.4g") == "-32 kN"
    assert in_words(71.0, "g") == "71 g"
    assert time_in_words(5.4321) == "5.4321 s"
    assert time_in_words(5e4) == "50000 s"


def test_columns_of_one_unit_share_the_one_that_suits_the_largest_of_them():
    columns = (Column("way", ".3g", si="m"), Column("error", ".3g", si="m"), Column("push", si="N"), Column("n"))
    table = Table.of(columns, ((2e-3, 3e-6, None, 4), (5e-3, None, 71.0, 5)))
    assert [one.head for one in table.columns] == ["way, mm", "error, mm", "push, N", "n"]
    assert [one.factor for one in table.columns] == [1e3, 1e3, 1.0, 1.0]
    assert replace(table, title="as it stands").columns == table.columns


def test_the_words_of_a_body_stand_over_it_and_not_over_a_force_that_is_near():
    """On a narrow screen, at the tip: in one row they stood between the words of the force and its arrow."""
    plain = scene_of(1.0)
    body = PointMass(position=0.37, mass=0.025, rotary_inertia=6e-6)
    beam = replace(plain.beam, supports=("clamped", "free"), mass=(body,))
    drive = replace(plain.drive, force=(replace(plain.drive.force[0], position=0.315),))
    picture = beam_drawing(replace(plain, beam=beam, drive=drive), NARROW)
    words = {told: float(x) for x, told in re.findall(r'<text x="([\d.]+)"[^>]*>([^<]*)</text>', picture)}
    (disc,) = map(float, re.findall(r'<circle cx="([\d.]+)"', picture))
    assert words["0.025 kg"] == words["6e-06 kg m²"] == disc
    assert words["x = 315 mm"] < disc
