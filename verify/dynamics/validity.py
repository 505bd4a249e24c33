"""Validity of a run: the size of the coupling of sliders and beam, and of what no time step removes."""

from functools import lru_cache
from math import inf

import numpy as np

from verify.dynamics.linear_system import Stage, steady_beam
from verify.dynamics.request import Request
from verify.dynamics.result import Coupling, Margins
from verify.linear.field import lossless_wavenumber, travelling_wavenumber
from verify.linear.surface import section_at
from verify.linear.time_basis import TimeBasis
from verify.problem.beam import Beam, PointForce

NEAR = 1e-3
"""Spacing of the forces that represent a couple, over the smaller of 1/k and L/50: it misses (k d)^2/24 = 4e-8."""


def coupling_of(request: Request, basis: TimeBasis | None, stage: Stage) -> Coupling:
    """Largest sizes over the sliders of a run with last stage `stage`, with the loads of all sliders.

    Friction mu N exerts a couple (h/2) mu N on the beam, which rotates the section and thereby moves the surface. The
    receptances are deflections under unit forces at every place, and slopes under unit couples. Raises InputError.
    """
    places, omega, beam, hertz = np.array(request.starts), request.omega, request.beam, request.frequency_hz
    couples = [couple(beam, x, hertz) for x in places.tolist()]
    if basis and request.start == "rest":  # all modes; slopes with truncated ones, whose sum decays as slowly as 1/n
        damping = request.damping_in(basis)
        compliance = 1.0 / (basis.omegas**2 - omega**2 + 2j * damping * basis.omegas * omega)
        shapes = [basis.shapes(places, derivative) for derivative in (0, 1)]
        receptances = [np.array([(compliance * here) @ psi for here in psi.T], dtype=complex) for psi in shapes]
        if basis.tail is not None:
            receptances[1] += [basis.tail(loads, hertz, damping)(places, 1) for loads in couples]
    else:
        case = request.model, request.count, beam
        forces = [(PointForce(position=x),) for x in places.tolist()]
        fields = [
            [steady_beam(*case, one, hertz, request.modal_damping).field for one in loads]
            for loads in (forces, couples)
        ]
        receptances = [np.array([one.derivative(places, k) for one in fields[k]]) for k in (0, 1)]
    half = np.array([section_at(request.beam, x).surface_distance for x in request.starts])
    drive = [abs(stage.drive_shapes(places, derivative)[0]) for derivative in (0, 1)]
    normal, friction = np.zeros(len(places)), np.zeros(len(places))
    for slider, lever, risen, turned in zip(request.sliders, half, *receptances, strict=True):
        with np.errstate(divide="ignore", invalid="ignore"):
            loaded = np.where(drive[0] > 0.0, slider.load * abs(risen) / drive[0], np.inf)
        normal += slider.mass * omega**2 * abs(risen) if slider.contact is None else loaded
        friction += slider.mu * slider.load * lever * half * omega * abs(turned)
    speeds = half * omega * drive[1]
    return Coupling(
        two_way=request.two_way,
        friction_size=float((friction / speeds).max()) if (speeds > 0.0).all() else None,
        normal_size=float(normal.max()),
    )


@lru_cache(maxsize=256)
def couple(beam: Beam, x: float, frequency_hz: float) -> tuple[PointForce, ...]:
    """A unit couple at x, 1 N m, as five close forces from x inwards: a difference quotient of order 4.

    Curvature jumps at a couple: the rotation of elements errs by up to 0.066 l/EI, of links 0.15, at an end 0.30.
    """
    near = NEAR * min(float(np.sqrt(beam.wave_constant / (2.0 * np.pi * frequency_hz))), 0.02 * beam.length)
    inwards = near if x < 0.5 * beam.length else -near
    places = x + inwards * np.arange(5)
    powers = np.vander((places - x) / inwards, increasing=True).T  # positions as rounded
    weights = np.linalg.solve(powers, np.eye(5)[1]) / inwards
    return tuple(PointForce(position=float(p), amplitude=float(w)) for p, w in zip(places, weights, strict=True))


def margins_of(request: Request, stage: Stage, contact_rate: float = 0.0) -> Margins:
    """Margins of a run with last stage `stage` and the fastest rate of its contact, rad/s.

    `lift_off` of point sliders is that of the run.
    """
    beam, hertz, x = request.beam, request.frequency_hz, np.linspace(0.0, request.beam.length, 400)
    lift_off = 0.0
    if request.feet or not request.sliders:
        falling = stage.omega**2 * float(abs(stage.drive_shapes(x, 0)[0]).max())
        lift_off = falling / request.gravity if request.gravity else inf
    square = 0.5 * float((abs(stage.drive_shapes(x, 1)[0]) ** 2).mean())
    turns, slips = abs(lossless_wavenumber(beam, hertz)) * beam.length, list[float | None]()
    for slider, start in zip(request.sliders, request.starts, strict=True):
        contact, section = slider.contact, section_at(beam, start)
        if contact is None or contact.hard:
            slips.append(None)
            continue
        compliances = [(contact.across(foot.length), contact.along(foot.length)) for foot in slider.feet]
        if all(along for _, along in compliances):
            k, ratio = travelling_wavenumber(section, hertz), max(across / along for across, along in compliances)
            slips.append(None if k is None else slider.mu * ratio / (k * section.surface_distance))
    return Margins(
        lift_off=lift_off,
        nonlinearity=float(turns**2 * square),
        presliding=None if None in slips or not request.feet else max((one for one in slips if one), default=0.0),
        contact_step=contact_rate * stage.steps.dt,
    )
