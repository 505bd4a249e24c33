"""The same beam told in other words does the same: every verb, whatever is cut, halved, turned round or reordered."""

import numpy as np
import pytest
from every_verb import CASES, Units
from msgspec.structs import replace

from verify import Section


def halves(one, *names):
    return [replace(one, **{name: share * getattr(one, name) for name in names}) for share in (0.375, 0.625)]


class Cut(Units):
    """Pieces cut in two, not in the middle; a uniform beam in three."""

    def beam(self, beam):
        if not beam.section:
            lengths = (self.length(0.29), self.length(0.21), self.length(0.33))
            return replace(beam, section=tuple(Section(length=one) for one in lengths))
        return replace(beam, section=tuple(half for one in beam.section for half in halves(one, "length")))


class Halved(Units):
    """Bodies, springs and forces as two at one place, the last first."""

    def beam(self, beam):
        return replace(
            beam,
            mass=tuple(half for one in beam.mass[::-1] for half in halves(one, "mass", "rotary_inertia")),
            spring=tuple(half for one in beam.spring[::-1] for half in halves(one, "stiffness", "rotational")),
        )

    def pushes(self, forces):
        return [half for one in forces[::-1] for half in halves(one, "amplitude")]


class Turned(Units):
    """Forces as their opposites half a period later, and a whole one."""

    def pushes(self, forces):
        return [replace(one, amplitude=-one.amplitude, phase_deg=one.phase_deg - 540.0) for one in forces]


class Weightless(Units):
    """Weight as preload."""

    def slider(self, slider):
        weight = slider.mass * slider.gravity
        return replace(slider, preload=slider.preload + weight, gravity=0.0)


WORDS = {"cut": Cut(), "halved": Halved(), "turned": Turned(), "weightless": Weightless()}
PLACED = [case for case in CASES if "analytic" in case]
"""Elements and links end where pieces do: cut elsewhere they are others, and so is their own error."""
UPRIGHT = [case for case in CASES if case != "carried along the surface"]
"""Weight pulls a slider down what it rides along, and a preload does not."""
ASKED = {"cut": PLACED, "halved": CASES, "turned": CASES, "weightless": UPRIGHT}


@pytest.mark.parametrize(("words", "case"), [(words, case) for words in ASKED for case in ASKED[words]])
def test_figures_are_the_same_in_other_words(words, case):
    verb, *given = CASES[case]
    for (_, expected), (_, found) in zip(verb(Units(), *given), verb(WORDS[words], *given), strict=True):
        wanted = np.asarray(expected)
        assert np.isfinite(wanted).all()
        assert abs(np.asarray(found) - wanted).max() <= 1e-9 * abs(wanted).max()
