"""The compiled contact engine, stage by stage: rows and tables of a stage, chunks of the loop, raw samples."""

from collections.abc import Callable, Sequence

import msgspec
import numpy as np

from verify.arrays import Array, ComplexArray, Indices
from verify.dynamics import layout as lay
from verify.dynamics.linear_system import Stage

CHUNK = 20_000
"""Steps between two checks for an interrupt."""
EVENTS = 20_000
"""Capacity of the event log."""


class Contacts(msgspec.Struct, eq=False, kw_only=True):
    """Sliders with their points on a beam, as arrays in the columns of `layout`; advanced in place by `run_stages`.

    `contact_assembly` fills them in; a run continues from copies of `sliders`, `feet` and `contacts`.
    """

    start: float
    """Position of the first slider at the start, m; distances and edges count from it, so that nanometres are exact."""
    sliders: Array
    """(sliders, SLIDER)"""
    feet: Array
    """(feet, FOOT); (0, FOOT) for points without feet."""
    points: Array
    """(points, POINT), in the order of the sliders; OFFSET from `start`, also of a second slider's points."""
    contacts: Array
    """(points, CONTACT)"""
    indices: Indices
    """(points, 3)"""
    law: int
    """GIVEN, BILATERAL or SPRING, of all points."""
    two_way: bool
    presses: bool
    """Whether normal forces act on the beam of a two-way run."""
    following: bool = False
    gravity: float = 0.0
    """m/s^2, along the slope for kinematics "following"."""
    moving_load: bool = False
    """Whether the run goes on without contact after a point has left the beam: a prescribed speed without friction."""
    restitution: float | None = None
    """Of rigid contact (`impact`): one point with a foot, one-way; None for the laws above."""


class Recorded(msgspec.Struct, eq=False, kw_only=True):
    """Raw samples, events and sums of a run; the sample before the first step is not among them."""

    samples: Array
    """(n, sliders, KEPT)"""
    heights: Array
    """(n, feet, 2): height and pitch."""
    pressures: Array
    """(n, points): normal forces."""
    deflections: Array
    """(n, places)"""
    events: Array
    """(m, 4): time, kind, point, distance travelled."""
    n_events: int
    """Events altogether, also beyond the capacity of `events`."""
    sums: Array
    """(sliders, SUMS)"""
    balance: Array
    """(BALANCE,)"""
    n_steps: int
    loop_s: float
    """Processor time of the compiled loop."""
    set_up_s: float
    """Processor time of tables and arrays."""
    stopped: str
    """"end", "left the beam" and the like (`Stage.beyond`), "diverged", "interrupted" or "chatters"."""
    z: ComplexArray
    """All of the motion of every row at the end, (n,)."""
    first: Array
    """(sliders, KEPT), the state before the first step: surface speed, friction by the law, normal force."""


def run_stages(
    stages: Sequence[Stage],
    z: ComplexArray,
    contacts: Contacts,
    places: Array,
    *,
    accounts: bool = False,
    progress: Callable[[int], None] = lambda steps: None,
) -> Recorded:
    """Advance a beam and its sliders through all stages.

    Parameters
    ----------
    stages : sequence of Stage
        Their `steps` set step, number of steps and sampling.
    z : (n,) complex
        Free part of the rows at the start of the first stage.
    contacts : Contacts
        Advanced in place; sums start at zero.
    places : (p,) array
        Positions of the deflection samples, m.
    accounts : bool
        Whether the work of the drive and the loss of the modes are integrated.
    progress : callable
        Called with the number of steps done.
    """
    raise NotImplementedError
