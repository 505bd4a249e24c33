"""Results of time integration."""

import numpy as np
from msgspec import Struct

from verify.arrays import Array
from verify.contact.state import Bodies
from verify.errors import InputError
from verify.formatting import one_line
from verify.problem.beam import Beam
from verify.problem.slider import Slider

END = "end"  # Value of `Statistics.stopped` of a complete run
FOOT_STATE = ("height", "velocity_z", "pitch", "pitch_rate")  # Columns of `EndState.feet`
NONE, NO_EVENTS, NO_CIRCUITS, NAN = np.empty(0), np.empty((0, 4)), np.empty((0, 0)), float("nan")


class Statistics(Struct, frozen=True, kw_only=True):
    """Cost of a run of a beam or a chain, and the reason of its end."""

    steps: int  # Number of time steps; 0 in closed form
    evaluations: int  # Number of evaluations of the surface under the slider, or of the closed form
    step_s: float  # Time step, s; 0 without steps
    set_up_s: float  # Wall time of modes and tables
    wall_s: float  # Wall time of the run itself
    loop_s: float = 0.0  # Processor time of the compiled loop
    step_change: float | None = None
    """Relative change of the slider's displacement when the step was last halved; None if it was not."""
    unconverged: int = 0  # Number of steps in which the contact forces did not converge
    stopped: str  # end, left the beam, came to a step (with its position), or diverged; for a chain with the time

    @property
    def finished(self) -> bool:
        """Whether the run reached its end."""
        return self.stopped == END


class EnergyBalance(Struct, frozen=True, kw_only=True):
    """Energies and works over a run, J. Works are positive where they add energy, losses where they remove it."""

    kinetic: float  # Gain of kinetic energy of the beam's free modes, and of the energy of inductances
    elastic: float  # Gain of elastic energy of the beam's free modes, and of the energy of capacitances
    slider: float  # Gain of kinetic energy of sliders and feet, along and across the beam
    contact_elastic: float  # Gain of elastic energy of normal and tangential contact springs
    drive_work: float  # Work of driving forces and sources; 0 in a steady field, whose drive is not computed
    load_work: float  # Work of weight, preload, `slider.external_force` and of the force that prescribes a speed
    tangential_work: float  # Work of the tangential motion of the surface on the sliders
    normal_work: float  # Work of the normal motion of the surface, dw/dt of its material, on the feet
    slope_work: float
    """Work N v w' of the slope along the path of the sliders; it has no counterpart in tangential kinematics, in which
    only friction and `slider.external_force` move a slider."""
    damping_loss: float  # Loss by damping in the beam
    circuit_loss: float = 0.0  # Loss in the resistances of circuits
    friction_loss: float
    contact_loss: float  # Loss in contact dashpots and impacts
    friction_on_beam: float  # Work of friction on the beam; not in the beam's balance with one-way coupling
    normal_on_beam: float  # Work of the normal forces on the beam; not in the beam's balance with one-way coupling
    initial: float  # Initial energy of the beam's modes: of the static deflection, or of the earlier run
    created: float  # Sum of the work of friction in steps in which it is positive: energy created by the discretisation
    slider_residual: float  # Residual of the balance of sliders and feet: work less gains and losses
    residual: float  # Larger residual of sliders and, from rest, of the beam: the error of the time integration

    @property
    def imbalance(self) -> float:
        """Magnitude of the residual over the work of the driving forces. Raises InputError where these do no work."""
        if not self.drive_work:
            raise InputError("drive.force does no work in this run: give it an amplitude, or measure slider.energy")
        return abs(self.residual / self.drive_work)

    @property
    def contact_imbalance(self) -> float:
        """Magnitude of the residual over the normal and tangential work of the surface."""
        return abs(self.residual) / (abs(self.normal_work) + abs(self.tangential_work))


class Coupling(Struct, frozen=True, kw_only=True):
    """Whether sliders and beam are coupled two-way, and the relative error of one-way coupling."""

    two_way: bool
    friction_size: float | None
    """Surface speed due to friction mu N over that due to the drive; None without surface motion by the drive."""
    normal_size: float
    """Surface motion due to the normal load over that due to the drive: N |G| / |w| with unilateral contact, else
    m omega^2 |G| of the slider's inertia. Infinite for a loaded surface without motion by the drive."""


class Margins(Struct, frozen=True, kw_only=True):
    """Validity of a run; each margin is small where its assumption holds."""

    lift_off: float
    """Largest downward acceleration of the surface over N / m: a free slider lifts off above 1.

    Under a point slider in the run; else the largest along the beam in the steady state."""
    nonlinearity: float
    """(kL)^2 <theta^2>: relative size of the axial inertia, neglected in linear theory, of a roller-ended chain.

    Mean over links and time. A scale, not a bound: the paper's beam at 4276 Hz departs by 0.6 of it at mid-span in the
    first millisecond from rest."""
    presliding: float | None = None
    """Presliding 2 mu kappa / (kappa_t k h): tangential deformation of the contact before it slips, relative to the
    surface motion. 0 for tangentially rigid contact; None without contact springs or without a travelling wave."""
    contact_step: float = 0.0
    """Natural frequency of the contact times the step, rad; its square over 24 is the relative period error."""


class EndState(Struct, frozen=True, eq=False, kw_only=True):
    """State from which a run continues."""

    beam: Beam
    model: str  # Name of the model
    count: int | None  # Segments or elements; None for the exact beam
    time: float  # Time since the start of the first run, s
    q: Array
    """(n,), sqrt(kg) m: modal amplitudes with their forced part; with start = 'steady' without the steady field. The
    charges of circuits follow, C."""
    rates: Array  # (n,), dq/dt
    steady: bool = False  # Whether the run had start = 'steady'
    starts: tuple[float, ...] = ()  # Initial positions of the sliders, m
    sliders: tuple[Slider, ...] = ()
    contact: Bodies | None = None  # Sliders, feet and points; None without slider
    off: str = ""  # Message for a slider that left its contact range; else empty
    __repr__ = one_line(time="s")

    @property
    def feet(self) -> Array:
        """(feet, 4): height, its rate, pitch, its rate; (0, 4) without feet."""
        if self.contact is None:
            return np.empty((0, 4))
        return np.stack([self.contact.feet[name] for name in FOOT_STATE], axis=1)

    @property
    def position(self) -> float | None:
        """Position of the first slider, m; None without slider."""
        return None if self.contact is None else self.starts[0] + float(self.contact.sliders["x"][0])

    @property
    def speed(self) -> float:
        """Speed of the first slider, m/s; 0 without slider."""
        return 0.0 if self.contact is None else float(self.contact.sliders["v"][0])


class Motion(Struct, frozen=True, eq=False, kw_only=True):
    """Motion of a linear beam, with or without sliders; arrays of one slider are (n,), of a sequence (n, sliders).

    Without slider the slider fields are empty, NaN or None. Friction, normal force and fractions of a slider with feet
    are means over the interval that ends at the sample; friction and surface speed of a point slider are instantaneous,
    except sticking friction.
    """

    model: str
    """Name of the model of the beam."""
    count: int | None
    """Elements or segments; None for the exact beam."""
    times: Array
    """(n,), s; evenly spaced in each piece of growth of the forces, and after it."""
    points: Array
    """(p,), m: positions of the deflection."""
    deflection: Array
    """(n, p), m."""
    voltages: Array = NO_CIRCUITS
    """(n, circuits), V across the actuators."""
    charges: Array = NO_CIRCUITS
    """(n, circuits), C on their electrodes; the current is the rate."""
    slider: Slider | tuple[Slider, ...] | None = None
    start: float | tuple[float, ...] | None = None
    """Initial position, m from the left end."""
    travelled: Array = NONE
    """Displacement along +x, m, without cancellation."""
    speed: Array = NONE
    """m/s."""
    friction: Array = NONE
    """Tangential force on the slider, N."""
    normal_force: Array = NONE
    """Normal force on the slider, N; may be negative in bilateral contact."""
    surface_speed: Array = NONE
    """Tangential velocity of the surface under the slider, m/s."""
    contact_fraction: Array = NONE
    """Fraction of points and time in contact, 0 to 1."""
    stick_fraction: Array = NONE
    """Fraction of points and time in stick, 0 to 1."""
    friction_loss: Array = NONE
    """Energy lost in friction and tangential compliance since the previous sample, J."""
    tangential_work: Array = NONE
    """Work of the tangential motion of the surface on the slider since the previous sample, J."""
    height: Array = NONE
    """(n, feet), height of the feet, m."""
    pitch: Array = NONE
    """(n, feet), pitch of the feet, rad."""
    pressures: Array = NONE
    """(n, points), normal force at each point in the middle of the last step, N."""
    point_offsets: Array = NONE
    """(points,), positions of the points relative to their slider, m."""
    events: Array = NO_EVENTS
    """(k, 4): time, kind (1 sticks, 2 slips, 4 lands, 5 leaves), point, distance travelled."""
    mean_friction: float | Array = NAN
    """Mean friction on the slider along +x over all steps, N; (sliders,) for a sequence."""
    largest_friction: float | Array = NAN
    """Largest friction of all steps, N."""
    mean_surface_speed: float | Array = NAN
    """Mean speed of the surface under the slider over all steps, m/s."""
    coupling: Coupling | None = None
    """Coupling of sliders and beam, and its size."""
    margins: Margins
    """Errors of the assumptions of the run."""
    energy: EnergyBalance | None = None
    notes: tuple[str, ...]
    """Notes on modes, damping, envelope, and events beyond the capacity."""
    statistics: Statistics
    end: EndState
    __repr__ = one_line(model="", count="", times="s", deflection="m", travelled="m")

    @property
    def position(self) -> Array:
        """Position of the slider, m from the left end."""
        return self.travelled + (0.0 if self.start is None else self.start)

    @property
    def displacement(self) -> float:
        """Displacement of a single slider over the run, m. Raises InputError for none or several."""
        if self.travelled.ndim != 1 or not len(self.travelled):
            raise InputError("displacement and mean_speed need a single slider: give one slider")
        return float(self.travelled[-1])

    @property
    def mean_speed(self) -> float:
        """Displacement over duration, m/s. Raises InputError without a slider."""
        return self.displacement / self.duration

    @property
    def energy_from_rest(self) -> EnergyBalance:
        """The energy balance. Raises InputError for a run with start = 'steady', whose drive is not computed."""
        if self.energy is None or self.end.steady:
            raise InputError("start = 'steady': the energy balance needs a run from rest, give start = 'rest'")
        return self.energy

    @property
    def duration(self) -> float:
        """Simulated seconds. Raises InputError where the slider left before the first sample."""
        if not (seconds := float(self.times[-1] - self.times[0])):
            raise InputError(f"samples: the slider {self.statistics.stopped} before the first one, give more")
        return seconds
