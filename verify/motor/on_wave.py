"""A rigid foot of one wavelength at a fixed height over a pure travelling wave, on springs or a layer of them.

What the closed forms of a driving layer are about, by the compiled loop of `run_motor`: points, steps and all.
"""

from math import cos, pi

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array
from verify.motion.pure_wave import wave_stage
from verify.motion.surface import cut
from verify.motor import records
from verify.motor.feet import Placed, feet_of, fresh_log
from verify.motor.figures import AtSpeed
from verify.motor.stepping import Riding, run_stages
from verify.problem.beam import Beam
from verify.problem.slider import Contact, Foot, Slider
from verify.validation import check_number, check_whole

WARM = 2
"""Periods before the one that counts: what gives way along the surface forgets how it began."""


def over_a_wave(
    beam: Beam,
    frequency_hz: float,
    *,
    speed_ratio: float,
    contact_half_angle: float,
    epsilon: float = 0.0,
    mu: float = 0.2,
    points: int = 61,
    steps_per_period: int = 256,
    amplitude: float = 1e-9,
) -> tuple[AtSpeed, float]:
    """(means over a period, speed of the crests in m/s) of a slider held at `speed_ratio` times that speed.

    The foot spans one wavelength of amplitude cos(omega t - k x), towards +x, at the height at which a half angle of
    every crest presses into it. `epsilon` = 2 mu kappa/(kappa_t k h) is its give along the surface. Friction is
    Coulomb's. Raises InputError.
    """
    check_number("contact_half_angle", contact_half_angle, "radians of the wave", above=0, below=pi)
    check_number("speed_ratio", speed_ratio, "over the speed of the crests")
    check_number("epsilon", epsilon, "2 mu kappa / (kappa_t k h)", at_least=0)
    check_whole("points", points, 2)
    check_whole("steps_per_period", steps_per_period, 4)
    one = wave_stage(beam, amplitude, frequency_hz)
    k = float(np.sqrt(one.omega / beam.wave_constant))
    length, thickness = 2.0 * pi / k, 2.0 * beam.surface_distance
    laid = cut((WARM + 1) * one.duration, one.duration / steps_per_period * (1.0 + 1e-9), WARM + 1)
    edges: Array = np.linspace(-0.01 * length, 1.01 * length, int(np.ceil(2.0 * pi / 0.3)) + 2)
    stage = replace(one, edges=edges, n_steps=laid.n, dt=laid.dt, every=laid.every)
    crest = beam.surface_distance * k * stage.omega * amplitude
    along = 2.0 * mu / (epsilon * k * thickness) if epsilon else None
    slider = Slider(
        mass=1.0,
        mu=mu,
        law="coulomb",
        contact=Contact(layer_stiffness=1.0, layer_tangential_stiffness=along),
        foot=(Foot(length=length, points=points, offset=0.5 * length, pitches=False),),
    )
    placed = (Placed(slider, 0.0, -speed_ratio * crest, True),)
    feet = feet_of(placed)
    feet.given[:, records.FOOT_INVERSE_MASS] = 0.0
    feet.state[:, records.HEIGHT] = amplitude * cos(contact_half_angle)
    log = fresh_log(WARM + 1, feet, np.zeros((0, 2)), 1)
    riding = Riding.of(feet, placed, beam, log, np.empty(0), False)
    run_stages([stage], [stage.table(0, len(stage.edges) - 1)], np.zeros((2, 0)), riding, lambda n: None)
    last, seconds = riding.log.kept[-1, 0], stage.duration / (WARM + 1)
    spreads = np.abs(last - riding.log.kept[-2, 0])
    return AtSpeed(
        speed=-speed_ratio * crest,
        force=float(last[records.KEPT_RUB]),
        normal_force=float(last[records.KEPT_PUSH]),
        contact_share=float(last[records.KEPT_TOUCHING]),
        stuck_share=float(last[records.KEPT_STICKING]),
        given=float(last[records.KEPT_ALONG]) / seconds,
        rubbed=float(last[records.KEPT_RUBBED]) / seconds,
        spread=float(spreads[records.KEPT_RUB]),
        normal_spread=float(spreads[records.KEPT_PUSH]),
        share_spread=float(spreads[[records.KEPT_TOUCHING, records.KEPT_STICKING]].max()),
        power_spread=float(spreads[[records.KEPT_ALONG, records.KEPT_RUBBED]].max()) / seconds,
        periods=WARM + 1,
        window=1,
        unsettled=(),
    ), crest
