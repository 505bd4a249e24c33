"""Driven beams evaluated: fields by model, measures, power, best frequency, orders."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Literal, TypeAlias

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.analysis.compare import relative_error, settled_order
from verify.arrays import Array
from verify.errors import InputError, ResonanceError
from verify.linear.catalogue import MODELS
from verify.linear.fields import HarmonicField, phasor
from verify.linear.search import Least, least_over
from verify.linear.sweeps import HarmonicSweep
from verify.problem.beam import Beam, PointForce
from verify.waves.case import DrivenCase
from verify.waves.imposed import driven_field
from verify.waves.results import WaveMeasures
from verify.waves.two_waves import (
    amplitudes_of,
    check_moving,
    crest_speed,
    mean_axis_ratio,
    measure,
    measured_figure,
    medium_of,
    middle_half,
    still,
    two_waves,
    window_rule,
)
from verify.waves.window import check_window

if TYPE_CHECKING:
    from verify.analysis.solution_cache import SolutionCache

Window: TypeAlias = tuple[float, float]


class Operation(msgspec.Struct, frozen=True, kw_only=True):
    """The wave at one frequency: what a motor is judged by."""

    frequency_hz: float
    standing_wave_ratio: float
    axis_ratio: float
    """Signed mean over the whole half wavelengths in the window's middle."""
    crest_speed: float
    """m/s for the scene's forces."""


SEARCH_SPAN = 0.015
"""Around the drive's frequency, relative."""


def driven(case: DrivenCase, bench: "SolutionCache") -> HarmonicField:
    """The field of a case, its solves kept on the bench. Raises InputError."""
    model = MODELS.named(case.model)

    def solve(forces: Sequence[PointForce], frequency: float) -> HarmonicField:
        key = (case.model, case.count, case.beam, frequency, tuple(forces), case.settings)
        if key not in bench.fields:
            bench.fields[key] = model.solve_harmonic(case.beam, forces, frequency, case.count, **dict(case.settings))
        return bench.fields[key]

    case.check_devices()
    if case.devices:
        field = _with_devices(case, bench)
    else:
        field = driven_field(solve, case.forces, case.frequency_hz, case.kind)
    case.check_carried()
    return field


def _with_devices(case: DrivenCase, bench: "SolutionCache") -> HarmonicField:
    """The same with devices on the beam. Raises InputError."""
    from verify.waves.devices import field_with_devices

    key = (case.model, case.count, case.beam, case.frequency_hz, case.forces, case.settings, case.devices)
    if key in bench.fields:
        return bench.fields[key]
    model, settings = MODELS.named(case.model), dict(case.settings)

    def solve(beam: Beam, forces: Sequence[PointForce], frequency: float) -> HarmonicField:
        return model.solve_harmonic(beam, forces, frequency, case.count, **settings)

    found = field_with_devices(solve, case.beam, case.forces, case.frequency_hz, case.devices)
    bench.fields[key] = found
    return found


def swept(case: DrivenCase, frequencies: Array, bench: "SolutionCache") -> HarmonicSweep:
    """The fields of a case under forces at many frequencies, kept on the bench. Raises InputError."""
    key = (case.model, case.count, case.beam, frequencies.tobytes(), case.forces, case.settings)
    if key not in bench.sweeps:
        solve = MODELS.named(case.model).sweep_harmonic
        bench.sweeps[key] = solve(case.beam, case.forces, frequencies, case.count, **dict(case.settings))
    return bench.sweeps[key]


def measures(field: HarmonicField, window: tuple[float, float] | None) -> WaveMeasures:
    """Measures in a window, the middle half unless given, with the model's own wavenumber stated. Raises InputError."""
    return measure(field, window or middle_half(field.beam), own_wavenumber(field))


def measured_alone(field: HarmonicField, window: Window | None, name: str) -> float:
    """One figure of these by its name, and nothing beside it. Raises InputError."""
    return measured_figure(field, window or middle_half(field.beam), own_wavenumber(field), name)


def operation(field: HarmonicField, window: Window | None = None) -> Operation:
    """These four of a field, as `measures` has them beside much else. Raises InputError."""
    window, medium = window or middle_half(field.beam), medium_of(field)
    waves = two_waves(field, window, own_wavenumber(field))
    return Operation(
        frequency_hz=field.frequency_hz,
        standing_wave_ratio=waves.standing_wave_ratio,
        axis_ratio=mean_axis_ratio(field.beam, window, field.deflection, field.turn, waves),
        crest_speed=float(crest_speed(medium, field.omega, waves.wavenumber, waves.forward, waves.backward)),
    )


def own_wavenumber(field: HarmonicField) -> complex:
    """The wavenumber at which waves run in the field's model, 1/m: exact, or by its discrete dispersion.

    That of the beam where no dispersion of the model is known: by another theory, under axial force, on the ground,
    with sections.
    """
    beam = field.beam
    known = field.theory == "euler-bernoulli" and not (beam.tension or beam.foundation or beam.section)
    if field.count is None or not known:
        return field.wavenumber
    free = replace(beam, mass=(), spring=()) if beam.mass or beam.spring else beam
    return MODELS.named(field.model).wavenumber(free, field.count, field.frequency_hz)


def power_imbalance(field: HarmonicField, wave: WaveMeasures) -> float:
    """(input of the forces left of the window - losses up to its middle - flux through it) over that flux.

    Raises NoFigureError where the wave stands.
    """
    field.beam.check_added("a power balance", ("mass", "spring", "tension", "foundation"))
    wave.waves.check_travelling()
    middle = 0.5 * sum(wave.window)
    left = [force for force in field.forces if force.position <= wave.window[0]]
    speeds = 1j * field.omega * field.deflection([force.position for force in left])
    given = sum(0.5 * (phasor(f) * np.conj(v)).real for f, v in zip(left, speeds, strict=True))
    points, weights = np.polynomial.legendre.leggauss(8)
    edges = _cell_edges(field, middle)
    half = 0.5 * np.diff(edges)
    x = (edges[:-1, None] + half[:, None] * (points + 1.0)).ravel()
    lost = _lost(field, x, (half[:, None] * weights).ravel())
    return float((given - lost - wave.energy_flux) / wave.energy_flux)


def _cell_edges(field: HarmonicField, end: float) -> Array:
    """Of cells from the left end to `end` metres in which a field is smooth, (n,), metres.

    Forces, bodies and springs stand on edges: the third derivative jumps at a force, the second where a couple acts.
    """
    of_forces, beam = [force.position for force in field.forces], field.beam
    places = np.array([*of_forces, *(m.position for m in beam.mass), *(s.position for s in beam.spring)])
    cells = max(int(end * field.wavenumber.real), 8)
    return np.unique(np.concatenate([np.linspace(0.0, end, cells), places[places < end]]))


def _lost(field: HarmonicField, x: Array, weights: Array) -> float:
    """Power that the loss factor takes over a quadrature, (n,) both, watt: of bending, EI |psi'|^2, and of shear.

    kappa G A |w' - psi|^2: all models have E (1 + i eta) in both.
    """
    beam = field.beam
    loss, shear = 0.5 * field.omega * beam.loss_factor, beam.own.shear_stiffness
    lost = loss * beam.bending_stiffness * float(abs(field.turns(x, 1)) ** 2 @ weights)
    if field.theory == "timoshenko" and shear is not None:
        lost += loss * shear * float(abs(field.shapes(x, 1) - field.turns(x, 0)) ** 2 @ weights)
    return lost


def best_frequency(case: DrivenCase, span: float, window: Window | None, bench: "SolutionCache") -> float:
    """The frequency within `span` of the drive's at which the reflection is least.

    Raises InputError where the reflection still falls at the edge of the search or the wave stands everywhere.
    """
    found = quietest_drive(case, span, window, bench)
    if found.at_edge:
        raise InputError(
            f"span = {span!r}: the reflection still falls at the edge of the search, {found.x:.6g} Hz, give a wider "
            "span or another frequency_hz"
        )
    return found.x


def quietest_drive(case: DrivenCase, span: float, window: Window | None, bench: "SolutionCache") -> Least:
    """Where within `span` of the drive's frequency the reflection is least. Raises InputError where the wave stands."""
    centre = case.frequency_hz

    def reflection(frequency: float) -> float:
        try:
            field = driven(replace(case, frequency_hz=frequency), bench)
        except ResonanceError:
            return 1.0  # on a resonance the wave stands
        return two_waves(field, window or middle_half(field.beam), own_wavenumber(field)).reflection

    def reflections(frequencies: Array) -> Array:
        if len(frequencies) > 1 and case.kind == "force" and not case.devices:
            with suppress(ResonanceError):
                return _swept_reflections(swept(case, frequencies, bench), window or middle_half(case.beam))
        return np.array([reflection(float(f)) for f in frequencies])

    grid = np.linspace((1.0 - span) * centre, (1.0 + span) * centre, 41)
    return quietest(reflections, grid)


def _swept_reflections(sweep: HarmonicSweep, window: Window) -> Array:
    """The reflection in a window at every frequency of a sweep, as `two_waves` finds it in each field, (n,)."""
    lowest, highest = (sweep.field(int(end(sweep.frequencies_hz))) for end in (np.argmin, np.argmax))
    for field in (lowest, highest):  # the longest waves and the shortest
        places = [force.position for force in field.forces]
        check_window(field.beam, places, field.frequency_hz, window, field.turning_held, field.theory)
    rule = window_rule(window, highest.wavenumber.real)
    deflections = sweep.deflection(rule.x)
    fields = [sweep.field(index) for index in range(len(sweep))]
    for index in np.flatnonzero(abs(deflections).max(axis=1) <= still(lowest)):  # which moves most of all for a force
        check_moving(fields[index], deflections[index])
    k = np.array([own_wavenumber(field) for field in fields])
    sizes = np.sort(abs(amplitudes_of(rule, k, deflections[:, None], 0.5 * sum(window))[:, :, 0]), axis=1)
    return np.asarray(sizes[:, 0] / sizes[:, 1])


def quietest(reflection: Callable[[Array], Array], frequencies: Array) -> Least:
    """Where a reflection over frequency is least, to 1e-5 Hz. Raises InputError where the wave stands everywhere."""
    found = least_over(reflection, frequencies, 1e-5)
    if found.value > 1.0 - 1e-6:
        raise InputError(
            f"phase_deg: with this phase between the forces the wave stands at every frequency from "
            f"{frequencies[0]:.6g} to {frequencies[-1]:.6g} Hz, so none is best, choose another phase_deg"
        )
    return found


def wave_order(
    case: DrivenCase,
    counts: Sequence[int],
    window: Window | None,
    of: Literal["standing_wave_ratio", "axis_ratio", "deflection"],
    bench: "SolutionCache",
) -> float:
    """The observed order of a discrete model's figure towards the exact field's of its theory. Raises InputError."""
    places = window or middle_half(case.beam)

    def figure(one: DrivenCase) -> complex:
        field = driven(one, bench)
        if of == "deflection":
            return complex(field.deflection(0.5 * sum(places))[0])
        found = operation(field, places)
        return complex(found.standing_wave_ratio if of == "standing_wave_ratio" else found.axis_ratio)

    told = MODELS.named("analytic").field_settings
    by_theory = tuple((name, given) for name, given in case.settings if name in told)
    exact = figure(replace(case, model="analytic", count=None, settings=by_theory))
    return settled_order(counts, [relative_error(figure(replace(case, count=n)), exact) for n in counts])
