"""The grid of contact, every combination of `contact_cells`, against regularised laws by Radau; energy, order, refusals.

`pytest -m product` runs the cells that repeat a path of the engine with another law or prescribed speed.
"""

import json
from pathlib import Path

import numpy as np
import pytest
from reference import contact_cells as grid

from verify import Excitation, Keep, PrescribedSlider, simulate
from verify.chain.slider_on_chain import slide_on_chain
from verify.errors import InputError

TABLE = json.loads(Path(grid.__file__).with_name("contact.json").read_text())
STEPS = 240, 480, 960
SEVERAL_WAYS = ("static", "feet", "unilateral", "chain")
"""Rigid feet at rest against each other by static friction: which of them sticks depends on the step, and in the
reference on the speed of creep. The impulse of friction does not."""


def repeats(cell):
    """One-way bilateral contact is prescribed; prescribed speeds and several following sliders by one law each."""
    return (
        (cell.normal == "bilateral" and cell.coupling == "one-way")
        or (cell.motion != "free" and cell.law != "static" and cell.normal != "hard")
        or (cell.kinematics == "following" and cell.points == "3" and cell.law != "tanh")
    )


CELLS = [
    pytest.param(cell, id=str(cell), marks=[pytest.mark.product] if repeats(cell) else [])
    for cell in grid.CELLS
    if not grid.refused(cell)
]


def run(cell, steps):
    speed, stays = grid.prescribed(cell)
    bodies = grid.sliders(cell)
    sliders = [PrescribedSlider(body, speed, stays) for body in bodies]
    given = {
        "slider": sliders[0] if len(sliders) == 1 else sliders,
        "step": 1.0 / (grid.HERTZ * steps),
        "keep": Keep(at=0.123, samples=2),
    }
    if cell.surface == "chain":
        drive = Excitation(grid.forces(cell), grid.HERTZ)
        return slide_on_chain(grid.STRIP, drive, grid.DURATION, count=grid.PARTS["chain"], **given)
    drive, more = Excitation(grid.forces(cell), grid.HERTZ, 2.0), {"start": "rest", "modal_damping": grid.DAMPING}
    return simulate(grid.STRIP, drive, grid.DURATION, model="fem", count=grid.PARTS["beam"], **more, **given)


def figures(motion):
    """Displacement of the first slider, m, impulse of friction, N s, deflection at the end, m."""
    first = np.ravel(motion.travelled[-1])[0]
    return np.array([first, np.sum(motion.mean_friction) * grid.DURATION, motion.deflection[-1, 0]])


@pytest.mark.parametrize("cell", CELLS)
def test_sliders_move_as_stiff_equations_of_a_regularised_law_say(cell):
    """Bands: 2e-6 of what friction at its limit could displace a slider by, 1e-4 of its impulse, 1e-4 of the deflection.

    Three times the uncertainty of the reference is added. The energy balance closes with order two, in a band of
    twice the largest residual of all cells.
    """
    values, uncertainties = (np.array(TABLE[str(cell)][part]) for part in ("value", "uncertainty"))
    first = grid.sliders(cell)[0]
    impulse = first.mu * values[2]
    bands = np.array([2e-6 * impulse * grid.DURATION / first.mass, 1e-4 * impulse, 1e-4 * abs(values[3])])
    bands += 3.0 * uncertainties[[0, 1, 3]]
    if all(word in cell for word in SEVERAL_WAYS):
        bands *= (np.inf, 1.0, 4.0)
    motions = [run(cell, steps) for steps in STEPS]
    errors = [abs(figures(motion) - values[[0, 1, 3]]) / bands for motion in motions]
    assert max(errors[-1]) < 1.0
    assert max(errors[0]) < 30.0  # order two: 16 times the bands, and its spread
    for steps, motion in zip(STEPS, motions, strict=True):
        energy = motion.energy
        works = energy.drive_work, energy.normal_work, energy.tangential_work, energy.friction_loss
        turning = 2e-5 if cell.kinematics == "following" else 0.0  # kinetic energy of the turning path
        assert abs(energy.residual) < (3e-5 * (240.0 / steps) ** 2 + turning) * sum(abs(work) for work in works)
        assert energy.friction_loss > -1e-8 * (energy.kinetic + energy.elastic)
        assert motion.statistics.unconverged == 0


@pytest.mark.parametrize("law", ["tanh", "coulomb"])
@pytest.mark.parametrize("normal", ["bilateral", "unilateral"])
def test_halving_the_step_quarters_the_difference(law, normal):
    """A smooth law and Coulomb's between its events, two-way coupled; differences of the deflection in three halvings."""
    cell = grid.Cell(law, "1", normal, "two-way", "tangential", "beam", "driven")
    found = np.array([figures(run(cell, steps))[2] for steps in (60, 120, 240, 480)])
    apart = abs(np.diff(found))
    assert np.log2(apart[0] / apart[2]) / 2.0 == pytest.approx(2.0, abs=0.4)


@pytest.mark.parametrize("normal", grid.AXES["normal"])
def test_combinations_that_no_model_covers_are_refused_in_a_sentence(normal):
    refused = [cell for cell in grid.CELLS if grid.refused(cell) and cell.normal == normal]
    assert len(refused) > 100
    for cell in refused:
        with pytest.raises(InputError) as refusal:
            run(cell, 240)
        assert str(refusal.value).count("\n") == 0
