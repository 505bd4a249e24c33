"""What a run of a slider on feet returns."""

from msgspec import Struct

from verify.arrays import Array
from verify.motion.contact import Margins
from verify.motion.result import Ride
from verify.problem.beam import Beam


class MotorMargins(Struct, frozen=True, kw_only=True):
    """How far a run can be believed beside what its beam says; each is small where its assumption holds."""

    epsilon: float | None
    """2 mu kappa / (kappa_t k h): how little the contact slips before it has given way. 0 where it does not give way,
    which is Coulomb's law at every point; None of a hard contact, and of one that does where no wave travels. k is that
    of a wave under the beam's tension and on its foundation, without losses."""
    step: float
    """Natural frequency of the contact times the step, radians: from 2 on it grows without bound. Its square over
    24 is the error of a swing on the springs."""
    sag: float | None
    """Static deflection of the beam under what presses the slider on, metres; one way it is left out. None where that
    would push away a beam that nothing holds."""
    sag_taken: bool
    """Whether the run has it."""
    chain: float | None
    """(kL)^2 <theta^2> of the drive: the axial inertia of a roller-ended chain that linear theory leaves out."""
    drawn: float | None = None
    """Speed along x of the links under the slider where it was put, m/s, rms over the run: bending draws a nonlinear
    chain in. None of a linear field, which leaves that out."""


class MotorLedger(Struct, frozen=True, kw_only=True):
    """Where the slider's energy went, joules, from the start of the run to its end."""

    kinetic: float
    """Gained by stage and feet, along and across the beam."""
    stored: float
    """Gained by the springs of the contact across the beam."""
    across: float
    """Work of the rising surface on the feet, dw/dt of its material."""
    uphill: float
    """Work on the feet of the slopes that the slider goes along, N v w'. Nothing along the beam pays for it: friction
    and `slider.pull` alone move a slider there."""
    along: float
    """Work of the surface's own motion along the beam on the slider."""
    pressed: float
    """Work of weight and preload."""
    pulled: float
    """Work of `slider.pull`, and of what holds a held speed."""
    rubbed: float
    """Lost in friction, and put into what gives way along the surface."""
    damped: float
    """Lost in the contact's dashpots."""
    impacts: float
    """Lost in hard landings."""
    on_beam: float
    """Work of the feet on the beam, which feels it where coupled two-way."""
    residual: float
    """What the books miss: springs over a step (order 2)."""


class MotorState(Struct, frozen=True, eq=False, kw_only=True):
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
    """(n,), all of every free mode's motion; empty for a steady beam."""
    rates: Array
    """(n,), dq/dt."""
    steady: bool
    """Whether the run had start = 'steady': `q` is then what moves beside the steady field."""
    travelled: float
    """Metres from where the slider was put."""
    speed: float
    """m/s."""
    feet: Array
    """(feet, 4): height, its rate, pitch, its rate."""
    touch: Array
    """(points, 19), as the compiled loop keeps them: forces, speeds and stretch of the last mid-step."""


class MotorRun(Ride, frozen=True, eq=False, kw_only=True):
    """What a slider that may leave the beam did: friction, shares, normal force are means over the interval before."""

    model: str
    """Of the beam; 'chain' for the nonlinear chain."""
    count: int | None
    """Its elements or segments; None for the exact beam."""
    points: Array
    """(p,), metres: where the deflection was asked for."""
    deflection: Array
    """(n, p), metres."""
    normal_force: Array
    """(n,), of all points together, newton."""
    contact_share: Array
    """(n,), of points and time that touch, 0 to 1."""
    stuck_share: Array
    """(n,), of points and time that stick, 0 to 1."""
    rubbed: Array
    """(n,), lost in friction in the interval before, joules."""
    carried: Array
    """(n,), work of the surface along the beam on the slider in the interval before, joules."""
    height: Array
    """(n, feet), metres."""
    pitch: Array
    """(n, feet), radians."""
    pressures: Array
    """(n, points), normal force at each point in the middle of the last step, newton."""
    point_offsets: Array
    """(points,), of the points from the slider's position, metres."""
    events: Array
    """(k, 4): time, kind (1 sticks, 2 slips, 4 lands, 5 leaves), point, distance travelled."""
    beam_margins: Margins
    """What the beam's own assumptions leave out."""
    motor_margins: MotorMargins
    """What the contact's leave out."""
    ledger: MotorLedger
    """Where the energy went."""
    state: MotorState
    """From where another run can go on (`continue_from`)."""


def uninterrupted(run: MotorRun) -> MotorRun:
    """A run that nobody broke off; of one that somebody did nothing is told. Raises KeyboardInterrupt."""
    if run.statistics.interrupted:
        raise KeyboardInterrupt
    return run
