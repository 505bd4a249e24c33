"""Results of motions in time."""

import numpy as np
from msgspec import Struct

from verify.arrays import Array
from verify.dynamics.validity import Coupling, Margins
from verify.errors import InputError
from verify.problem.beam import Beam
from verify.problem.slider import Slider

END = "end"
"""Why a run stopped: at its end, or by the user."""
NONE, NO_EVENTS, NAN = np.empty(0), np.empty((0, 4)), float("nan")


class Statistics(Struct, frozen=True, kw_only=True):
    """Cost of a run and why it ended, of a beam or of a chain."""

    steps: int
    """0 in closed form."""
    evaluations: int
    """Of the surface under the slider, or of the closed form."""
    step_s: float
    """Seconds; 0 without steps."""
    set_up_s: float
    """Wall time of modes and tables."""
    wall_s: float
    """Wall time of the run itself."""
    loop_s: float = 0.0
    """Processor time of the compiled loop."""
    step_change: float | None = None
    """Relative change of the slider's displacement by the last halving of the step; None where none was halved."""
    unconverged: int = 0
    """Steps in which the contact forces did not converge."""
    stopped: str
    """end, left the beam, came to a step (and where), or diverged; a chain's adds when."""

    @property
    def finished(self) -> bool:
        """Whether it reached its end."""
        return self.stopped == END


class EnergyBalance(Struct, frozen=True, kw_only=True):
    """Energies and works over a run, J. Works are positive where they add energy, losses where they remove it."""

    kinetic: float
    """Gained by the free modes of the beam, kinetic."""
    elastic: float
    """The same, elastic."""
    slider: float
    """Kinetic energy gained by sliders and feet, along and across the beam."""
    contact_elastic: float
    """Gained by normal and tangential contact springs."""
    drive_work: float
    """Work of the driving forces; 0 in a steady field, whose drive is not computed."""
    load_work: float
    """Work of weight, preload, `slider.external_force` and of what prescribes a speed."""
    tangential_work: float
    """Work of the surface's own motion along the beam on the sliders."""
    normal_work: float
    """Work of the rising surface, dw/dt of its material, on the feet."""
    slope_work: float
    """Work on sliders of slopes that they move along, N v w': no force along the beam pays for it in tangential
    kinematics, in which friction and `slider.external_force` alone move a slider."""
    damping_loss: float
    """In the beam."""
    friction_loss: float
    contact_loss: float
    """In dashpots of the contact and in impacts."""
    friction_on_beam: float
    """Work of friction on the beam; one-way coupling does not charge the beam with it."""
    normal_on_beam: float
    """Work of the normal forces on the beam, likewise."""
    initial: float
    """Energy of the modes of the beam at the start: of its static deflection, or of the motion before."""
    created: float
    """Sum of the positive works of friction in single steps, in which it returns what it has dissipated before."""
    slider_residual: float
    """Works on sliders and feet less their gains and losses."""
    residual: float
    """The same of the sliders or, from rest, of the beam, whichever is larger: the error of the time integration."""


class ContactState(Struct, frozen=True, eq=False):
    """Sliders, feet and points at the end of a run, as the compiled loop has them (`layout`)."""

    sliders: Array
    """(sliders, 2): distance travelled and speed."""
    feet: Array
    """(feet, 4): height, its rate, pitch, its rate."""
    points: Array
    """(points, columns of memory)."""


class EndState(Struct, frozen=True, eq=False, kw_only=True):
    """State from which a run continues."""

    beam: Beam
    model: str
    """Its name."""
    count: int | None
    """Segments or elements; None of the exact beam."""
    time: float
    """Seconds from the first start."""
    q: Array
    """(n,), sqrt(kg) m: every mode with its forced part; beside the steady field with start = 'steady'."""
    rates: Array
    """(n,), dq/dt."""
    steady: bool = False
    """Whether the run had start = 'steady'."""
    starts: tuple[float, ...] = ()
    """Initial positions of the sliders, m."""
    sliders: tuple[Slider, ...] = ()
    contact: ContactState | None = None
    """State of the sliders; None of a beam alone."""
    off: str = ""
    """What a slider did that left its contact range; empty otherwise."""

    @property
    def feet(self) -> Array:
        """(feet, 4): height, its rate, pitch, its rate; (0, 4) without feet."""
        return np.empty((0, 4)) if self.contact is None else self.contact.feet

    @property
    def position(self) -> float | None:
        """Position of the first slider, m; None of a beam alone."""
        return None if self.contact is None else self.starts[0] + float(self.contact.sliders[0, 0])

    @property
    def speed(self) -> float:
        """Speed of the first slider, m/s; 0 of a beam alone."""
        return 0.0 if self.contact is None else float(self.contact.sliders[0, 1])


class Motion(Struct, frozen=True, eq=False, kw_only=True):
    """A linear beam in time, with sliders or alone; arrays of one slider are (n,), of a sequence (n, sliders).

    Of a beam alone the fields of sliders are empty, NaN or None. Friction, normal force and shares of a slider with
    feet are means over the interval that ends at the sample; friction and surface speed of a point slider are
    instantaneous, but for friction that sticks.
    """

    model: str
    """Name of the model of the beam."""
    count: int | None
    """Elements or segments; None for the exact beam."""
    times: Array
    """(n,), seconds; evenly while the forces grow and after, with another interval."""
    points: Array
    """(p,), m: places of the deflection."""
    deflection: Array
    """(n, p), m."""
    slider: Slider | tuple[Slider, ...] | None = None
    start: float | tuple[float, ...] | None = None
    """Initial position, m from the left end."""
    travelled: Array = NONE
    """Displacement along +x, m, to full digits."""
    speed: Array = NONE
    """m/s."""
    friction: Array = NONE
    """Tangential force on the slider, N."""
    normal_force: Array = NONE
    """Normal force on the slider, N; of a bilateral contact it may be negative."""
    surface_speed: Array = NONE
    """Tangential velocity of the surface under the slider, m/s."""
    contact_share: Array = NONE
    """Share of points and time in contact, 0 to 1."""
    stuck_share: Array = NONE
    """Share of points and time that stick, 0 to 1."""
    friction_loss: Array = NONE
    """Energy lost in friction and tangential compliance over the interval before, J."""
    tangential_work: Array = NONE
    """Work of the surface's motion along the beam on the slider over the interval before, J."""
    height: Array = NONE
    """(n, feet), m."""
    pitch: Array = NONE
    """(n, feet), rad."""
    pressures: Array = NONE
    """(n, points), normal force at each point in the middle of the last step, N."""
    point_offsets: Array = NONE
    """(points,), of the points from their slider, m."""
    events: Array = NO_EVENTS
    """(k, 4): time, kind (1 sticks, 2 slips, 4 lands, 5 leaves), point, distance travelled."""
    mean_friction: float | Array = NAN
    """Friction on the slider along +x, mean over all steps, N; (sliders,) of a sequence."""
    largest_friction: float | Array = NAN
    """Largest friction of all steps, N."""
    mean_surface_speed: float | Array = NAN
    """Speed of the surface under the slider, mean over all steps, m/s."""
    coupling: Coupling | None = None
    """Coupling of sliders and beam, with sizes."""
    margins: Margins
    """What the assumptions of the run leave out, with sizes."""
    energy: EnergyBalance | None = None
    notes: tuple[str, ...]
    """Modes, damping, envelope, events beyond the capacity."""
    statistics: Statistics
    end: EndState

    @property
    def position(self) -> Array:
        """Of the slider, m from the left end."""
        return self.travelled + (0.0 if self.start is None else self.start)

    @property
    def displacement(self) -> float:
        """Of the one slider from its start to the end of the run, m. Raises InputError without one."""
        if self.travelled.ndim != 1 or not len(self.travelled):
            raise InputError("displacement and mean_speed are those of one slider: give slider")
        return float(self.travelled[-1])

    @property
    def mean_speed(self) -> float:
        """Displacement over duration, m/s. Raises InputError without a slider."""
        return self.displacement / self.duration

    @property
    def duration(self) -> float:
        """Simulated seconds. Raises InputError where the slider left before the first sample."""
        if not (seconds := float(self.times[-1] - self.times[0])):
            raise InputError(f"samples: the slider {self.statistics.stopped} before the first one, give more")
        return seconds
