"""Waves under unit forces or unit displacements, superposed to the figures that a map takes from them."""

from collections.abc import Callable

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, BoolArray, ComplexArray
from verify.checks import check_number
from verify.errors import InputError, NoFigureError, ResonanceError
from verify.linear.catalogue import MODELS
from verify.linear.fields import unit_response, wavenumber
from verify.problem.beam import Beam
from verify.waves.imposed import held_units
from verify.waves.results import reflections, standing_wave_ratios
from verify.waves.two_waves import (
    STILL,
    amplitudes_of,
    crest_speed,
    energy_flux,
    window_rule,
    zero_field,
)
from verify.waves.waveguide import Medium
from verify.waves.window import check_halves, check_room, check_span

EULER = "euler-bernoulli"
MOST_READINGS = 50_000_000
"""Complex deflections that a map holds at once: 0.8 GB, and as much again twice while waves are fitted."""


class Gaps:
    """Points of a map without a figure, counted by the kind of reason."""

    def __init__(self) -> None:
        self._found: dict[type[NoFigureError], tuple[int, NoFigureError]] = {}

    def add(self, error: NoFigureError, points: int = 1) -> None:
        """Count `points` that have no figure for this reason."""
        counted, first = self._found.get(type(error), (0, error))
        self._found[type(error)] = counted + points, first

    def reasons(self, n_points: int) -> tuple[str, ...]:
        """A sentence for each kind of reason. Raises the first reason where no point of the map has a figure."""
        if sum(counted for counted, _ in self._found.values()) == n_points:
            raise next(iter(self._found.values()))[1]
        return tuple(
            f"{counted} of {n_points} points have no figure: {first}" for counted, first in self._found.values()
        )


class UnitWaves(msgspec.Struct, frozen=True, eq=False):
    """The two waves in a window under a unit drive at each place, at the frequencies that have them."""

    known: BoolArray
    """(n,), which of the frequencies asked for; m of them."""
    k: ComplexArray
    """(m,), 1/m."""
    forward: ComplexArray
    """A+, (m, n_places)."""
    backward: ComplexArray
    """A-, (m, n_places)."""


class UnitDrive(msgspec.Struct, frozen=True, kw_only=True):
    """A unit force, or a unit displacement with the others at rest, at each of some places on a model's beam."""

    beam: Beam
    model: str
    count: int | None
    kind: str
    """Force or displacement."""
    places: tuple[float, ...]
    window: tuple[float, float]
    theory: str = "euler-bernoulli"
    """Of the beam."""

    def waves(self, frequencies: Array, gaps: Gaps, points: int = 1) -> UnitWaves:
        """The waves over frequencies (n,). `gaps` counts those without, each for so many `points`.

        Raises InputError where the model or the window is none.
        """
        highest = float(frequencies.max())
        check_span(self.beam, list(self.places), self.window, theory=self.theory)
        check_room(self.beam, highest, self.window, self.theory)  # or it suits none of them
        rule = window_rule(self.window, wavenumber(self.beam, highest, self.theory).real)
        if (n := len(frequencies) * len(self.places) * len(rule.x)) > MOST_READINGS:
            raise InputError(
                f"frequency_hz: {len(frequencies)} frequencies read at {len(rule.x)} points each are {n:.1e} figures, "
                f"more than {MOST_READINGS:.0e}: give fewer steps, or a narrower window"
            )
        fields = self._responses(frequencies, rule.x)
        steady = [bool(np.isfinite(field).all()) for field in fields]
        k = np.full(len(frequencies), np.nan, dtype=complex)
        for i, frequency in enumerate(frequencies):
            try:
                k[i] = self._wavenumber(float(frequency), steady[i])
            except NoFigureError as error:
                gaps.add(error, points)
        known = np.isfinite(k)
        waves = amplitudes_of(rule, k[known], fields[known], 0.5 * sum(self.window))
        return UnitWaves(known, k[known], waves[:, 0], waves[:, 1])

    def _wavenumber(self, frequency: float, steady: bool) -> complex:
        """The model's own. Raises NoFigureError where the frequency has none, or no steady field."""
        check_halves(self.beam, frequency, self.window, self.theory)
        if not steady:
            raise resonant(self.model, frequency, " held at its actuators" if self.kind == "displacement" else "")
        known = self.theory == EULER and not (self.beam.tension or self.beam.foundation or self.beam.section)
        if self.count is None or not known:
            return wavenumber(self.beam, frequency, self.theory)
        free = replace(self.beam, mass=(), spring=()) if self.beam.mass or self.beam.spring else self.beam
        return MODELS.named(self.model).wavenumber(free, self.count, frequency)

    def _responses(self, frequencies: Array, x: Array) -> ComplexArray:
        """Deflection at x, (n, n_places, len(x))."""
        places = np.array(self.places)

        def units(acting: Array, f: Array, at: Array) -> ComplexArray:
            return unit_fields(self.model, self.beam, tuple(acting.tolist()), f, at, self.count, self.theory)

        return (
            units(places, frequencies, x)
            if self.kind == "force"
            else held_units(units, places, self.beam, frequencies, x)
        )


def unit_fields(
    model: str,
    beam: Beam,
    places: tuple[float, ...],
    frequencies: Array,
    x: Array,
    count: int | None,
    theory: str = EULER,
) -> ComplexArray:
    """Deflection at x under a unit force at each place by a model's name, (n, n_places, len(x)), m/N.

    NaN at undamped resonances. Raises InputError.
    """
    found, settings = MODELS.named(model), {} if theory == EULER else {"theory": theory}
    if settings and "theory" not in found.field_settings:
        raise InputError(f"theory = {theory!r} is no setting of model = {model}: leave it out")
    return found.unit_responses(beam, places, frequencies, x, count, **settings)


def receptance(
    model: str, beam: Beam, place: float, frequency_hz: float, x: float, count: int | None, theory: str = EULER
) -> complex:
    """Deflection at x under a unit force at `place`, m/N; both in metres. Raises InputError."""
    for name, value in (("position", place), ("x", x)):
        check_number(name, value, "metres on the beam", at_least=0.0, below=beam.length * (1.0 + 1e-12))
    found = unit_fields(model, beam, (place,), np.array([frequency_hz]), np.array([x]), count, theory)[0, 0, 0]
    if not np.isfinite(found):
        raise resonant(model, frequency_hz)
    return complex(found)


def resonant(model: str, frequency_hz: float, held: str = "") -> ResonanceError:
    """What there is to say of an undamped model at a resonance."""
    return ResonanceError(
        f"frequency_hz = {frequency_hz!r} is an undamped resonance of the {model} model{held}: give the beam "
        "a loss_factor or choose another frequency"
    )


def _reflection(medium: Medium, omega: Array, k: ComplexArray, forward: ComplexArray, backward: ComplexArray) -> Array:
    return reflections(forward, backward)


def _standing_wave_ratio(
    medium: Medium, omega: Array, k: ComplexArray, forward: ComplexArray, backward: ComplexArray
) -> Array:
    return standing_wave_ratios(_reflection(medium, omega, k, forward, backward))


FIGURES: dict[str, Callable[[Medium, Array, ComplexArray, ComplexArray, ComplexArray], Array]] = {
    "reflection": _reflection,
    "standing_wave_ratio": _standing_wave_ratio,
    "crest_speed": crest_speed,
    "energy_flux": energy_flux,
}
"""Figures of two waves from their amplitudes: (medium, omega, wavenumber, A+, A-) -> (n, p)."""


def superposed(
    drive: UnitDrive, names: tuple[str, ...], frequencies: Array, first: complex, second: ComplexArray, gaps: Gaps
) -> list[Array]:
    """`FIGURES` by name under complex amplitudes of the first and, (p,), of the second drive, (n, p) each.

    NaN where there is none, counted by `gaps`. Raises InputError where the model or the window is none.
    """
    waves = drive.waves(frequencies, gaps, len(second))
    return figures_of(drive, waves, names, frequencies, first, second, gaps)


def figures_of(
    drive: UnitDrive,
    waves: UnitWaves,
    names: tuple[str, ...],
    frequencies: Array,
    first: complex,
    second: ComplexArray,
    gaps: Gaps,
) -> list[Array]:
    """The same of waves that are known; `second` is (p,), or (m, p) at the frequencies that have them."""
    f, k = frequencies[waves.known, None], waves.k[:, None]
    forward, backward = (w[:, 0, None] * first + w[:, 1, None] * second for w in (waves.forward, waves.backward))
    unit = [unit_response(drive.beam, float(g)) if drive.kind == "force" else 1.0 for g in f[:, 0]]
    scale = np.array(unit)[:, None] * (abs(first) + abs(second))
    still = np.maximum(abs(forward), abs(backward)) <= STILL * scale
    if still.any():
        gaps.add(zero_field(), int(still.sum()))
        forward[still] = 1.0  # anything: it has no figure
    found = []
    for name in names:
        values = np.full((len(frequencies), second.shape[-1]), np.nan)
        figure = FIGURES[name](Medium(drive.beam, drive.theory), 2.0 * np.pi * f, k, forward, backward)
        values[waves.known] = np.where(still, np.nan, figure)
        found.append(values)
    return found
