"""What scikit-fem does in the elements, held to be its doing, and its own element as a subject beside ours."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.elements import linear
from verify.elements.in_time import time_basis
from verify.elements.stock import stock_frequency_hz
from verify.scene.load import load_scene
from verify.section import Section

PAPER = load_scene("paper").beam
STRIP = Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=113e9, density=4470.0)
STEPS = (Section(length=0.16), Section(length=0.04, thickness=0.0031), Section(length=0.23, youngs_modulus=61e9))
STEPPED = replace(STRIP, section=STEPS, supports=("clamped", "guided"))
FORCES = [PointForce(position=0.0137), PointForce(position=0.2911, amplitude=0.7, phase_deg=63.0)]


def works():
    """Everything the model is asked for, by name."""
    return {
        "modes": lambda: linear.solve_modes(STRIP, 5, 23).frequencies_hz,
        "modes of many elements": lambda: linear.solve_modes(STEPPED, 5, 300, grading=1.4).frequencies_hz,
        "field": lambda: linear.solve_harmonic(STRIP, FORCES, 777.0, 23).deflection([0.1417]),
        "unit responses": lambda: linear.unit_responses(STRIP, [0.1], np.array([777.0]), np.array([0.1417]), 23),
        "motion on equal elements": lambda: time_basis(STRIP, 23).omegas,
        "motion on a stepped beam": lambda: time_basis(STEPPED, 23).omegas,
    }


def raising(*_, **__):
    raise ZeroDivisionError("scikit-fem's is gone")


@pytest.mark.parametrize("work", works())
@pytest.mark.parametrize("form", ["bending", "inertia"])
def test_without_scikit_fems_assembly_there_is_no_model(form, work, monkeypatch):
    from verify.elements import element

    monkeypatch.setattr(getattr(element, form), "_kernel", raising)
    with pytest.raises(ZeroDivisionError):
        works()[work]()


@pytest.mark.parametrize("beam", [PAPER, STRIP, replace(STRIP, supports=("clamped", "free"))], ids=str)
@pytest.mark.parametrize(("count", "least", "most"), [(49, 1e-13, 1e-9), (400, 3e-11, 1e-6), (3000, 3e-7, 3e-3)])
def test_scikit_fems_own_element_loses_digits_with_the_size(beam, count, least, most):
    """Mode 1 of the paper's beam: 1e-11, 7e-9, 3e-5. Rounding, so that the bands are wide; it grows about like N^4."""
    off = stock_frequency_hz(beam, 1, count) / linear.solve_modes(beam, 1, count).frequencies_hz[0] - 1
    assert least < abs(off) < most
