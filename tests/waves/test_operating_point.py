"""Sensitivities of an operating point, against the closed form of two waves between two forces on a pinned beam."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify.beam import PointForce
from verify.errors import ResonanceError
from verify.models.catalogue import MODELS
from verify.waves import measures as travelling_wave
from verify.waves import operating_point
from verify.waves.case import DrivenCase
from verify.waves.driven import own_wavenumber
from verify.waves.operating_point import Landscape, driven_point, fastest_point

WINDOW = (0.1825, 0.5475)
"""The middle half of 0.73 m."""


def reflection(beam, frequency, phase_deg):
    """Gamma between two equal forces at equal distances: |sin((kL + phi)/2)| over |sin((kL - phi)/2)|, or its inverse.

    w ~ sin k(L - x) + e^{i phi} sin kx; the near field e^{-kL/4} is left out.
    """
    turn, phi = beam.length * np.sqrt(2 * np.pi * frequency / beam.wave_constant), np.deg2rad(phase_deg)
    sizes = sorted(abs(np.sin(0.5 * (turn + side * phi))) for side in (1, -1))
    return sizes[0] / sizes[1]


def land(beam, model="analytic", count=None):
    drives = (PointForce(position=0.021, amplitude=1.3), PointForce(position=0.709, amplitude=1.3))
    return Landscape(beam=beam, forces=drives, model=model, count=count)


def mean_change(beam, frequency, phase, hertz, degrees):
    """Over half a step on each side."""
    middle = reflection(beam, frequency, phase)
    ahead, back = (reflection(beam, frequency + s * hertz, phase + s * degrees) for s in (0.5, -0.5))
    return abs(ahead - middle) + abs(back - middle)


@pytest.mark.parametrize(("turns", "phase"), [(17.31, 77.0), (17.69, 77.0), (18.27, -128.0), (17.5, 90.0)])
def test_sensitivities_are_the_mean_changes_of_the_closed_form(titanium_strip, turns, phase):
    """In size, on a slope and in the least reflection alike: there both sides rise, and no change is less than zero."""
    frequency = (turns * np.pi / 0.73) ** 2 * titanium_strip.wave_constant / (2 * np.pi)
    found = land(titanium_strip).point(frequency, phase, "here")
    assert found.reflection == pytest.approx(reflection(titanium_strip, frequency, phase), rel=1e-4, abs=1e-6)
    assert found.per_hertz == pytest.approx(mean_change(titanium_strip, frequency, phase, 1.0, 0.0), rel=1e-4, abs=1e-7)
    assert found.per_degree == pytest.approx(
        mean_change(titanium_strip, frequency, phase, 0.0, 1.0), rel=1e-4, abs=1e-7
    )
    assert min(found.per_hertz, found.per_degree) > 5e-4
    assert (found.frequency_hz, found.phase_deg, found.what, found.note) == (frequency, phase, "here", "")


def test_a_pure_wave_is_spoilt_by_half_a_degree_as_by_half_its_sine(titanium_strip):
    """Where kL = 17.5 pi, phi = 90 degrees: Gamma = |tan(delta/2)| for a phase or a turn kL that is off by delta."""
    frequency = (17.5 * np.pi / 0.73) ** 2 * titanium_strip.wave_constant / (2 * np.pi)
    least = land(titanium_strip).quiet_point(np.linspace(0.98, 1.02, 101) * frequency, 90.0)
    assert least.reflection < 1e-5
    assert least.frequency_hz == pytest.approx(frequency, rel=1e-7)
    assert least.per_degree == pytest.approx(2 * np.tan(np.pi / 720), rel=1e-4)
    off = 17.5 * np.pi * 0.5 / (2 * frequency)
    assert least.per_hertz == pytest.approx(2 * np.tan(off / 2), rel=1e-3)


@pytest.mark.parametrize("least", [False, True], ids=["on a slope", "at the least reflection"])
@pytest.mark.parametrize(("model", "count"), [("analytic", None), ("fem", 60), ("segment", 75)])
def test_a_point_reads_what_the_field_itself_measures(titanium_strip, model, count, least):
    """The sum over unit forces against one field solved directly, with losses and unequal forces.

    Least reflection is no zero with losses: there the change over half a hertz is not that over one and a half.
    """
    beam = replace(titanium_strip, loss_factor=0.013)
    drives = (PointForce(position=0.021, amplitude=1.3, phase_deg=0.0), PointForce(position=0.66, amplitude=0.9))
    here = Landscape(beam=beam, forces=drives, model=model, count=count)
    frequency = here.quiet_point(np.linspace(1400.0, 1600.0, 41), 68.0).frequency_hz if least else 1510.0
    found = here.point(frequency, 68.0, "here")

    def measured(frequency, phase):
        turned = (drives[0], replace(drives[1], phase_deg=phase))
        field = MODELS[model].solve_harmonic(beam, turned, frequency, count)
        return travelling_wave.measure(field, WINDOW, own_wavenumber(field))

    direct = measured(frequency, 68.0)
    assert found.reflection == pytest.approx(direct.reflection, rel=1e-6)
    assert found.crest_speed == pytest.approx(direct.crest_speed, rel=1e-6)
    for name, hertz, degrees in (("per_hertz", 0.5, 0.0), ("per_degree", 0.0, 0.5)):
        sides = [measured(frequency + s * hertz, 68.0 + s * degrees).reflection for s in (1, -1)]
        expected = sum(abs(side - direct.reflection) for side in sides)
        assert getattr(found, name) == pytest.approx(expected, rel=1e-4), name
        assert expected > 1e-6


@pytest.mark.parametrize(
    ("search", "edge"),
    [((0.98, 1.02), 0.98), ((1.0, 1.03), 1.03), ((0.94, 1.0), None), ((1.01, 1.06), None)],
)
def test_the_fastest_point_says_whether_it_is_one_or_where_the_search_ends(titanium_strip, search, edge):
    """Towards each resonance crests grow faster: the search ends on its lower or its upper edge, or finds the top."""
    lossy = replace(titanium_strip, loss_factor=1e-3)
    middle = (17.5 * np.pi / 0.73) ** 2 * lossy.wave_constant / (2 * np.pi)
    frequencies = np.linspace(*search, 61) * middle
    found = land(lossy).fast_point(frequencies, 90.0, 0.1)
    assert found.reflection <= 0.1 + 1e-12
    reflection, speed = land(lossy).over(frequencies, np.linspace(5.0, 175.0, 681))
    assert abs(found.crest_speed) >= abs(speed)[reflection <= 0.1].max()
    if edge is None:
        assert frequencies[1] < found.frequency_hz < frequencies[-2]
        assert found.note == ""
    else:
        assert found.frequency_hz == pytest.approx(edge * middle, rel=1e-6)
        assert f"grows off the search, at its edge, {found.frequency_hz:.6g} Hz" in found.note
        assert found.what == "crest speed with a reflection up to 0.1, grows off the search, at its edge"


@pytest.mark.parametrize("model", ["analytic", "fem", "segment"])
def test_a_point_that_resonates_or_whose_neighbour_does_says_so(titanium_strip, model):
    """A change is read half a hertz to both sides."""
    here = land(titanium_strip, model, None if model == "analytic" else 90)
    resonance = float(MODELS[model].solve_modes(titanium_strip, 18, 90).frequencies_hz[17])
    for away in (-0.5, 0.0, 0.5):
        with pytest.raises(ResonanceError, match="undamped resonance"):
            here.point(resonance + away, 77.0, "there")
    assert here.point(resonance + 0.7, 77.0, "there").per_hertz > 0.0


@pytest.mark.parametrize("lead", [270.0, -90.0, 630.0])
def test_a_lead_and_that_lead_less_a_turn_are_one_drive(titanium_strip, lead):
    """Crests run the same way, whatever turns a phase is told with."""
    forces = tuple(
        PointForce(position=x, amplitude=1.3, phase_deg=11.0 + more) for x, more in ((0.041, 0.0), (0.673, lead))
    )
    lossy = replace(titanium_strip, loss_factor=0.02)
    case = DrivenCase(beam=lossy, model="analytic", count=None, forces=forces, frequency_hz=900.0)
    assert driven_point(case).phase_deg == -90.0
    assert fastest_point(case, 0.9).phase_deg < 0.0


@pytest.mark.parametrize(
    ("lead", "told"),
    [
        (75.5, 75.5),
        (180.0, 180.0),
        (180.5, -179.5),
        (-180.0, 180.0),
        (-180.5, 179.5),
        (270.0, -90.0),
        (901.25, -178.75),
    ],
)
def test_a_lead_lies_above_minus_half_a_turn_and_up_to_half_a_turn(titanium_strip, lead, told):
    forces = PointForce(position=0.041, phase_deg=11.0), PointForce(position=0.673, phase_deg=11.0 + lead)
    case = DrivenCase(beam=titanium_strip, model="analytic", count=None, forces=forces, frequency_hz=900.0)
    assert operating_point._between(case) == pytest.approx(told, abs=1e-9)
