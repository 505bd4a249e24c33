"""A strip under two forces that leave one wave running in its middle, and a motor on it."""

from functools import cache

import numpy as np
from msgspec.structs import replace
from reference.motor import Waves, waves_of

from tests.beams import PAPER as STRIP
from verify import ExactModel, Excitation, Keep, PointForce, PrescribedSlider, simulate

HERTZ = 4276.0
OMEGA, PERIOD = 2.0 * np.pi * HERTZ, 1.0 / HERTZ
PLACES = (0.0116, 0.5 - 0.0173)
MIDDLE = 0.2437
HALF = 0.5 * STRIP.thickness
PAIR = (PointForce(position=0.0116, amplitude=2.1), PointForce(position=0.4884, amplitude=1.9, phase_deg=83.0))


@cache
def drive(amplitude, backward=0.0):
    """(forces, Waves in the middle): a wave to the right of this amplitude, metres, `backward` of it coming back."""
    units = [ExactModel(STRIP).harmonic(PointForce(position=place), HERTZ) for place in PLACES]
    k = float(abs(units[0].wavenumber))
    waves = [waves_of(unit.deflection, k, OMEGA, MIDDLE) for unit in units]
    matrix = np.array([[one.forward for one in waves], [one.backward for one in waves]])
    pushes = np.linalg.solve(matrix, [amplitude, backward * amplitude])
    forces = tuple(
        PointForce(position=place, amplitude=float(abs(push)), phase_deg=float(np.rad2deg(np.angle(push))))
        for place, push in zip(PLACES, pushes, strict=True)
    )
    return forces, Waves(amplitude + 0j, backward * amplitude + 0j, k, OMEGA)


def on_strip(
    slider,
    amplitude=1e-6,
    backward=0.0,
    periods=5,
    steps=None,
    samples=11,
    speed=None,
    fixed_position=False,
    start=None,
):
    """A motor on the steady exact strip, from MIDDLE unless the slider has a position; `steps` per period."""
    slider = replace(slider, position=MIDDLE) if slider.position is None else slider
    return simulate(
        STRIP,
        Excitation(drive(amplitude, backward)[0], HERTZ),
        periods * PERIOD,
        model="analytic",
        slider=PrescribedSlider(slider, speed, fixed_position),
        start=start,
        step=PERIOD / steps if steps else None,
        keep=Keep(samples=samples),
    )
