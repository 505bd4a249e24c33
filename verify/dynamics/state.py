"""State of a beam in time and the record of a run, as the compiled loop advances them, SI throughout.

A surface is a sum of columns: a shape, on every piece of the beam a polynomial in the local coordinate xi in [0, 1],
times a factor of time. Columns 0..n-1 are the (real parts of the) shapes psi of the modal rows, factor Re z; then the
imaginary parts of the last `n_complex` rows, factor -Im z; then the drive's, in pairs (t/T)^d (cos, -sin)(omega s).
"""

from typing import NamedTuple

from verify.arrays import Array, Indices
from verify.contact.state import Records, record

DONE, OFF_PIECES, NOT_FINITE, CHATTERS = range(4)  # Why a compiled loop returns
START, HALF, MIDDLE, END = range(4)
"""Instants of a step. HALF is mid-step; MIDDLE has the deflection of mid-step and, of feet, the MEAN velocity over the
step, displacement/dt, which is exact for every row. Of points without feet it has the velocity with which Simpson's
rule gives that mean, so that means of products of rates and slopes are of order 4 as well."""
VALUE, RATE = range(2)


class Rows(NamedTuple):
    """Modal rows z' = lambda z + c f, real and imaginary parts, (n,) each."""

    z_re: Array
    z_im: Array
    rate_re: Array  # lambda, 1/s
    rate_im: Array
    half_re: Array  # e^{lambda dt/2}
    half_im: Array
    gain_re: Array
    """G = c (e^{lambda dt} - 1)/lambda: what a unit force that is constant over the step adds to z by its end."""
    gain_im: Array
    end_re: Array  # What it adds to the rate, lambda G
    end_im: Array
    coarse: Array
    """1 where the step does not resolve the row: the mean rate of the step, G/dt of a force, stands for its end."""


class Harmonic(NamedTuple):
    """Time of the drive."""

    omega: float  # Angular frequency, rad/s
    origin: float  # Seconds before the stage
    unit: float  # T of the powers of time, s


class Surface(NamedTuple):
    """Columns of the surface on pieces of the beam."""

    table: Array  # (pieces, degree + 1, columns), coefficients of the shapes
    edges: Array  # (pieces + 1,), m from the first slider's start
    factors: Array  # (4, 2, columns), factors and their rates at the instants of the step
    polynomials: Array  # (pieces, 2, degree + 1), deflection and its rate at an instant
    stamps: Indices  # (pieces,), marks of the instants of `polynomials`


class Beam(NamedTuple):
    """A beam that advances by its rows and its drive."""

    rows: Rows
    n_complex: int  # Number of rows with a complex shape, the last ones
    harmonic: Harmonic
    surface: Surface


class Accounts(NamedTuple):
    """What the work of the drive and the loss in the beam are computed from."""

    kept: bool
    forced: Array
    """(drive columns, n): coordinates over the drive's factors, added to those of the rows themselves; with circuits
    over the factors of all columns, (columns, coordinates)."""
    loads: Array  # (4, coordinates): generalised force phasors, real and imaginary, damping, and 1 of a circuit
    growth: Array  # Envelope of the forces, ascending powers of t/T
    rates: Array  # (coordinates,), working space


SUMS = record(
    "normal_work slope_work tangential_work external_work load_work friction_loss contact_loss friction_on_beam",
    "normal_on_beam friction_time normal_time touch_time stick_time surface_time max_friction max_fall stored",
)
"""Sums over all steps of a slider. Works, J: of the surface across and up its slopes on the feet, along on the slider,
of the external force or a prescribed speed, of preload and weight; friction loss; loss in dashpots and impacts; work on
the beam of friction, of normal forces. Integrals over time: friction (on the slider, N s), normal force, share of
points in contact and sticking, displacement of the surface under the points in contact (mean of points). The largest
friction, N; the largest downward acceleration of the surface, m/s^2; energy of the springs, J."""
BALANCE = record("driven lost resisted created unconverged")
"""Work of the drive, loss in modes and circuits, of it in circuits, J (of a run that keeps accounts); energy that
friction created, the sum of positive contact works of all steps, J; steps whose contact solution did not converge."""
SAMPLE = record(
    "travelled speed friction normal_force contact_fraction stick_fraction friction_loss tangential_work surface_speed"
)
"""A sample of a slider, by the names of `result.Motion`: friction, normal force, shares and surface speed (of points in
contact) are means over the interval that ends with the sample, friction loss and work of the surface along are its
sums. Of points without feet, friction, surface speed and normal force are of the instant: the law at the sample, the
mean of the last step where it sticks."""
PROGRESS = record(integers="step samples events")  # Steps of the stage, samples and events so far


class Journal(NamedTuple):
    """What a run records."""

    progress: Records  # (1,), PROGRESS
    samples: Records  # (samples, sliders), SAMPLE
    heights: Array  # (samples, feet, 2), heights and pitches of the feet
    pressures: Array  # (samples, points), normal forces of the points
    deflections: Array  # (samples, places), deflection and readings
    places: Array  # (places, columns), the columns at the places of the deflection
    events: Array  # (capacity, 4), rows (time, kind, point, distance)
    sums: Records  # (sliders,), SUMS
    sums_before: Records  # (sliders,), SUMS at the last sample
    balance: Records  # (1,), BALANCE
    slider_of_foot: Indices  # (feet,)
