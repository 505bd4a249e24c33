"""The switch over the friction law of a point. A law is a file with five functions; here each has its line.

force   mean friction of a point in a step, N, with its own response: of `Slip`. Sets `holds`; of a set-valued law also
        `slip_by_law` and the events. Called by the sweeps of `solver`, for a slider's single point, and by impacts.
slope   least and largest mean friction and its derivative on a `Path` without response: an increasing function of the
        end of the path gives less friction, else sliders of several points have several solutions. Called by `one_way`
        with start and end, by `active_sets` (start = end, no limit) and for the friction at the instant of a sample.
limits  largest friction, N, at which the force no longer grows with the slip; infinite where the law itself bounds it
power   dissipated power on a `Path`, W, of feet on a surface without response
update  state at the end of the step (of a law that stores energy also under feet); mean relative speed, m/s
"""

from verify.contact import coulomb, elastic, tanh
from verify.contact.state import COULOMB, ELASTIC, TANH, Path, Record, Slip
from verify.jit import inline, jit, once


@inline
def set_valued(law: int) -> bool:
    """Whether a point of this law sticks without slip, so that its force is not a function of the slip."""
    return law == COULOMB


@inline
def stores_energy(law: int) -> bool:
    """Whether a point has a state that gives energy back, so that its friction may do work on the slider."""
    return law == ELASTIC


@jit(no_cpython_wrapper=True)
def force(slip: Slip, normal: float, slider: Record, point: Record, contact: Record) -> float:
    """Mean friction in the step, N; sets `holds`, and of a rigid point `slip_by_law` and its events."""
    contact.holds, contact.events = 0.0, 0
    if slider.mu * normal <= 0.0:
        return 0.0
    if point.law == TANH:
        return tanh.force(slip, normal, slider, point, contact)
    if point.law == COULOMB:
        return coulomb.force(slip, normal, slider, point, contact)
    return elastic.force(slip, normal, slider, point, contact)


@inline
def slope(path: Path, normal: float, slider: Record, point: Record, contact: Record) -> tuple[float, float, float]:
    """(Least, largest mean friction, N, derivative by the end of the path); they differ where a rigid point rests."""
    if point.law == TANH:
        return tanh.slope(path, normal, slider, point, contact)
    if point.law == COULOMB:
        return coulomb.slope(path, normal, slider, point, contact)
    return elastic.slope(path, normal, slider, point, contact)


@inline
def limits(slider: Record, point: Record, contact: Record) -> float:
    """Largest friction, N, infinite where the law itself bounds the force."""
    if point.law == TANH:
        return tanh.limits(slider, contact)
    if point.law == COULOMB:
        return coulomb.limits(slider, contact)
    return elastic.limits(slider, contact)


@once
def power(path: Path, normal: float, slider: Record, point: Record, contact: Record) -> float:
    """Dissipated power of the step, W."""
    if point.law == TANH:
        return tanh.power(path, normal, slider, contact)
    if point.law == COULOMB:
        return coulomb.power(path, normal, slider, contact)
    return elastic.power(path, normal, slider, contact)


@once
def update(slip: Slip, normal: float, slider: Record, point: Record, contact: Record) -> float:
    """Set the state of a point at the end of the step; mean of its relative speed, m/s."""
    if point.law == TANH:
        return tanh.update(slip, normal, slider, point, contact)
    if point.law == COULOMB:
        return coulomb.update(slip, normal, slider, point, contact)
    return elastic.update(slip, normal, slider, point, contact)
