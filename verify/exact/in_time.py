"""The first exact modes for motion in time: what is cut off is said."""

from collections.abc import Callable, Sequence

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.checks import check_whole
from verify.errors import InputError
from verify.exact.harmonic import solve_harmonic
from verify.exact.layout import line_up
from verify.exact.modes import mode_shapes, solve_modes
from verify.linear.fields import phasor
from verify.linear.places import as_typed
from verify.linear.time_basis import TimeBasis, check_held
from verify.problem.beam import Beam, PointForce

DEGREE = 8
"""Of the Taylor pieces: the fastest mode is followed to 1e-9, the others far closer."""
KNOWN = 16
"""Evaluations kept: the four derivatives that are not multiples of others, at a few sets of places."""
MOST = 5000
"""Modes kept: their shapes are evaluated one by one."""


def check_beam(beam: Beam, instead: str = "give model = 'fem' or 'segment'") -> None:
    """Raise InputError for a beam that `time_basis` does not take, with what to do `instead`."""
    beam.check_added("the exact beam in time", ("section", "mass"), instead)
    check_held(beam)


@as_typed
def time_basis(beam: Beam, n_modes: int) -> TimeBasis:
    """The first n_modes exact modes, of a beam of sections and point masses too.

    A damping ratio is the same in every mode, as the material's loss factor makes it: springs, foundation and axial
    force, which lose nothing, are refused. Raises InputError for them, rigid motions and n_modes not in 1..MOST.
    """
    check_beam(beam)
    check_whole("modes", n_modes, 1)
    if n_modes > MOST:
        raise InputError(f"modes = {n_modes!r}: the exact beam keeps at most {MOST}, the rest follow at once")
    modes = solve_modes(beam, n_modes)
    omegas = 2.0 * np.pi * modes.frequencies_hz
    fourth = omegas**2 / beam.wave_constant**2  # beta^4 of the beam's own section

    known: dict[tuple[bytes, int], Array] = {}  # a table asks for the same places many times

    def shapes(x: Array, derivative: int) -> Array:
        turns, rest = divmod(derivative, 4)
        key = x.tobytes(), rest
        if key not in known:
            if len(known) >= KNOWN:
                known.clear()
            known[key] = mode_shapes(beam, n_modes, x, rest)
        return np.asarray(known[key] * (fourth[:, None] * _ratio(beam, x)) ** turns)

    return TimeBasis(
        model="analytic",
        count=None,
        beam=beam,
        omegas=omegas,
        shapes=shapes,
        loads=lambda position: shapes(np.array([position]), 0)[:, 0],
        edges=_edges(beam, float(fourth[-1])),
        degree=DEGREE,
        method=f"the first {n_modes} exact modes, the rest following at once",
        tail=lambda forces, frequency, damping: _tail(beam, omegas, shapes, forces, frequency, float(damping)),
    )


def _ratio(beam: Beam, x: Array) -> Array:
    """Rho A / EI at x over that of the beam's own section, (len(x),) or (1,): what beta^4 goes with."""
    line = line_up(beam)
    ratios = np.array([stretch.mass / stretch.stiffness for stretch in line.stretches])
    if len(ratios) == 1:
        return ratios
    inner = np.array(line.places[1:-1]) * beam.length
    return np.asarray(ratios[np.searchsorted(inner, x, side="right")])


def _edges(beam: Beam, fourth: float) -> Array:
    """Ends of cells of 0.4 wavenumbers of the fastest mode at most, at all sections and masses too."""
    line, edges = line_up(beam), [np.zeros(1)]
    for stretch, start in zip(line.stretches, line.places, strict=False):
        beta = (fourth * stretch.mass / stretch.stiffness) ** 0.25
        cells = int(np.ceil(stretch.length * beam.length * beta / 0.4)) + 1
        end = start + stretch.length
        edges.append(np.linspace(start * beam.length, end * beam.length, cells + 1)[1:])
    edges[-1][-1] = beam.length
    return np.concatenate(edges)


def _tail(
    beam: Beam,
    omegas: Array,
    shapes: Callable[[Array, int], Array],
    forces: Sequence[PointForce],
    frequency_hz: float,
    damping: float,
) -> Callable[[Array, int], ComplexArray]:
    """The exact field less the part of the modes that are kept: what far faster modes answer without delay."""
    lossy = replace(beam, loss_factor=2.0 * damping)
    field = solve_harmonic(lossy, forces, frequency_hz)
    loads = sum(phasor(f) * shapes(np.array([f.position]), 0)[:, 0] for f in forces)
    kept = loads / (omegas**2 * (1.0 + 2j * damping) - (2.0 * np.pi * frequency_hz) ** 2)

    def rest(x: Array, derivative: int) -> ComplexArray:
        turns, left = divmod(derivative, 4)
        exact = field.shapes(x, left) * (field.wavenumber**4 * _ratio(beam, x)) ** turns
        return np.asarray(exact - kept @ shapes(x, derivative))

    return rest
