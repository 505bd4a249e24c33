"""What a simulation returns: times, what was asked to be kept, what it cost, where the energy went."""

from msgspec import Struct

from verify.arrays import Array
from verify.errors import InputError
from verify.motion.contact import Coupling, Margins
from verify.problem.beam import Beam
from verify.problem.slider import Slider

END, INTERRUPTED = "end", "interrupted"
"""Why a run stopped that went as far as it was asked to."""


class Statistics(Struct, frozen=True, kw_only=True):
    """What a run cost and why it ended, of a beam or of a chain."""

    steps: int
    """0 where the motion was evaluated in closed form."""
    evaluations: int
    """Of the surface under the slider, or of the closed form."""
    step_s: float
    """Seconds; 0 without stepping."""
    set_up_s: float
    """Wall time of modes and tables."""
    wall_s: float
    """Wall time of the run itself."""
    loop_s: float = 0.0
    """Processor time of a slider's compiled loop, of the one thread that runs it; 0 without one."""
    moved: float | None = None
    """Part of a slider's way by which halving the step last moved it; None where no second run judged the step."""
    stopped: str
    """end, interrupted, left the beam, came to a step (and where), or diverged; a chain's adds when."""

    @property
    def finished(self) -> bool:
        """Whether it went as far as it was asked to."""
        return self.stopped == END

    @property
    def interrupted(self) -> bool:
        """Whether it was broken off from outside; of a chain the first word says so, the rest when."""
        return self.stopped.partition(" ")[0] == INTERRUPTED


class Ledger(Struct, frozen=True, kw_only=True):
    """Where the energy went, joules, from the start of the run to its end."""

    kinetic: float
    """Of the beam, at the end."""
    elastic: float
    """Of the beam, at the end."""
    slider: float
    """Gained by the slider."""
    work_in: float
    """Of the driving forces."""
    damped: float
    """Lost in the beam."""
    rubbed: float
    """Lost in friction."""
    contact_on_beam: float
    """Work of friction on the beam; under one-way coupling the beam is not charged with it."""
    normal_on_beam: float
    """Work of the normal reaction on the beam; 0 under one-way coupling and of a slider without normal inertia."""
    residual: float
    """What the books miss: with a slider the quadrature of the power over a step (order 4), without one rounding."""
    turned: float = 0.0
    """Work on a slider that follows the surface of the tangent's turning and of gravity along it."""


class EndState(Struct, frozen=True, eq=False, kw_only=True):
    """From where a run can go on."""

    beam: Beam
    """Whose motion it is."""
    model: str
    """Of whose modes."""
    count: int | None
    """Segments or elements; None of the exact beam."""
    time: float
    """Seconds from the first start."""
    q: Array
    """(n,), all of every mode's motion, its forced part included; empty for a steady beam."""
    rates: Array
    """(n,), dq/dt."""
    steady: bool = False
    """Whether the run had start = 'steady': `q` is then what moves beside the steady field."""
    position: float | None = None
    """Of the slider, metres; None where there was none."""
    speed: float = 0.0
    """Of the slider, m/s."""
    stuck: bool = False
    """Whether the slider sticks to the surface."""
    height: float | None = None
    """Of a slider held on the surface, metres; None where it did not push back."""
    climb: float = 0.0
    """Its speed across the beam, m/s."""
    off: str = ""
    """What the slider had done that left the surface it ran on, from where it cannot go on; empty otherwise."""


class Ride(Struct, frozen=True, eq=False, kw_only=True):
    """What a slider did on a surface in motion, of a linear beam or of a nonlinear chain."""

    times: Array
    """(n,), seconds; evenly while the forces grow and after, with another interval."""
    slider: Slider | None
    """As it was asked for; None where nothing lay on the beam."""
    start: float | None
    """Where the slider began, metres from the left end; None without one."""
    travelled: Array
    """(n,), metres along +x from there, to full digits; empty without a slider, so for the following."""
    speed: Array
    """(n,), m/s."""
    friction: Array
    """(n,), tangential force on the slider, newton."""
    surface_speed: Array
    """(n,), tangential velocity of the material under the slider, m/s."""
    coupling: Coupling | None
    """Whether the beam felt the slider, with sizes; None without one."""
    statistics: Statistics
    """What the run cost and why it ended."""
    notes: tuple[str, ...]
    """What stands for what: modes, damping, soft start, coupling."""

    @property
    def position(self) -> Array:
        """(n,), of the slider, metres from the left end."""
        return self.travelled + (self.start or 0.0)

    @property
    def displacement(self) -> float:
        """Of the slider from its start to the end of the run, metres. Raises InputError where none runs."""
        if not len(self.travelled):
            raise InputError("displacement and mean_speed are a slider's, and the beam moves alone: give slider")
        return float(self.travelled[-1])

    @property
    def mean_speed(self) -> float:
        """Displacement over duration, m/s. Raises InputError where no slider runs."""
        return self.displacement / self.duration

    @property
    def duration(self) -> float:
        """What was simulated, seconds. Raises InputError where the slider was gone before the first sample."""
        if not (seconds := float(self.times[-1] - self.times[0])):
            raise InputError(
                f"the slider {self.statistics.stopped} before the first sample: change its position, speed or mu, or "
                "ask for more samples"
            )
        return seconds


class Slid(Ride, frozen=True, eq=False, kw_only=True):
    """The same of a slider whose run is added up step by step, whatever is kept of it."""

    mean_friction: float
    """On the slider along +x, of all steps of the run, newton; NaN without a slider."""
    largest_friction: float
    """In size, of all steps: the law's at their starts; of what sticks, or nearly, their means, newton."""
    mean_surface_speed: float
    """Of the material under the slider, of all steps, m/s; NaN without a slider."""


class Motion(Slid, frozen=True, eq=False, kw_only=True):
    """A linear beam, and perhaps a slider on it, in time."""

    model: str
    """Its name."""
    count: int | None
    """Elements or segments; None for the exact beam."""
    points: Array
    """(p,), metres: where the deflection was asked for."""
    deflection: Array
    """(n, p), metres."""
    normal_force: Array
    """(n,), normal reaction on the slider, mean over the step that ends there, newton: m g + preload, and m times the
    acceleration of the surface for a slider held on it. Below 0 the surface holds it back."""
    events: Array
    """(k, 3): time, kind (1 sticks, 2 slips) and distance travelled by the end of that step, for Coulomb friction."""
    margins: Margins
    """How far the run can be believed: what its assumptions leave out, with sizes."""
    ledger: Ledger | None
    """Where the energy went, joules; None where it was not booked."""
    end: EndState
    """From where another run can go on (`continue_from`)."""
