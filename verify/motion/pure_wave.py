"""A slider always in contact with a pure travelling wave: the speed it settles at, by stepping one period."""

from math import isfinite

import numpy as np

from verify.arrays import Array
from verify.errors import InputError
from verify.exact.closed_forms import check_uniform
from verify.motion.contact import law_of
from verify.motion.forcing import CONSTANT
from verify.motion.records import Law, Rider, V, X
from verify.motion.stepping import Sliding, fresh_motion, run_stages
from verify.motion.surface import ANALYTIC_DEGREE, NO_MODES, Stage
from verify.problem.beam import Beam
from verify.problem.slider import Slider
from verify.validation import check_number

STEPS = 1024
"""Of one period."""


def wave_stage(beam: Beam, amplitude: float, frequency_hz: float, mean: float = 0.0) -> Stage:
    """One period of the wave amplitude cos(omega t - k x), as a slider of mean speed `mean` meets it.

    Raises InputError for a stepped beam.
    """
    check_uniform(beam)
    omega = 2.0 * np.pi * frequency_hz
    k = float(np.sqrt(omega / beam.wave_constant))

    def drive(x: Array, derivative: int) -> Array:
        values = amplitude * (-1j * k) ** derivative * np.exp(-1j * k * x)
        return np.array([values.real, values.imag])

    return Stage(
        modal=NO_MODES,
        forced=None,
        free_shapes=lambda x, derivative: np.empty((0, len(x))),
        drive_shapes=drive,
        from_modes=None,
        load_rows=lambda position: drive(np.array([position]), 0)[:, 0],
        edges=np.linspace(0.0, beam.length, int(beam.length * k / 0.3) + 2),
        degree=ANALYTIC_DEGREE,
        omega=omega,
        origin=0.0,
        unit_s=1.0,
        growth=CONSTANT,
        n_steps=STEPS,
        every=STEPS,
        dt=2.0 * np.pi / (omega - k * mean) / STEPS,
    )


def terminal_speed(beam: Beam, slider: Slider, amplitude: float, frequency_hz: float) -> float:
    """Mean speed along +x of the slider's periodic motion on a wave towards +x, m/s.

    The speed at the start of a period is sought at which the period gives it back; a period is one of the wave
    as the slider meets it. Raises InputError where friction lets no such motion be found.
    """
    from scipy.optimize import brentq

    check_number("amplitude", amplitude, "metres", above=0)
    slider.check_stays()
    law, start, mean = law_of(slider, beam), slider.start_on(beam), 0.0
    for _ in range(3):
        stage = wave_stage(beam, amplitude, frequency_hz, mean)
        k = np.sqrt(stage.omega / beam.wave_constant)
        reach = 2.0 * k * stage.omega * amplitude * (beam.surface_distance + amplitude)

        def gained(speed: float, stage: Stage = stage) -> float:
            after = _period(stage, law, start, speed)[1]
            if not isfinite(after):
                raise InputError(f"amplitude = {amplitude!r} m: a wave so steep throws the slider off, lower it")
            return after - speed

        if not gained(-reach) > 0.0 > gained(reach):
            raise InputError(f"amplitude = {amplitude!r} m: friction is too weak to settle, raise mu or slope")
        speed = float(brentq(gained, -reach, reach, xtol=1e-15 * reach, rtol=1e-14))
        mean = _period(stage, law, start, speed)[0] / stage.duration
    return float(mean)


def _period(stage: Stage, law: Law, x: float, speed: float) -> tuple[float, float]:
    """(distance travelled, speed) after one period."""
    sliding = Sliding.fresh(x, 1, np.empty(0), Rider(fresh_motion(speed), law, None), False)
    run_stages([stage], np.zeros((2, 0)), sliding, (), lambda n: None)
    return float(sliding.motion[X]), float(sliding.motion[V])
