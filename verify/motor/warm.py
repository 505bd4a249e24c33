"""The calls for which the kernels of a slider on feet are compiled, with values of the right kinds."""

from collections.abc import Iterator

import numpy as np

from verify.models.compiling import Call
from verify.motion.records import Drive, Surface
from verify.motor.feet import Placed, feet_of, fresh_log
from verify.motor.records import BeamAnswer, Feet, Hard, Line, Log, Rubbing
from verify.motor.stepping import reckoned
from verify.slider import Contact, Slider

SLOPES = {"coulomb": None, "tanh": 1.0}


def calls() -> Iterator[Call]:
    """Springs and hard landings, on a beam and on a chain, each law and coupling."""
    for law in SLOPES:
        yield from on_springs(law, "auto")
        yield from hard(law)


def on_beam(slider: Slider) -> Iterator[Call]:
    """A slider on a linear beam, as its contact and its coupling say."""
    if slider.contact is not None and slider.contact.hard:
        return hard(slider.law)
    return on_springs(slider.law, slider.coupling)


def on_springs(law: str, coupling: str) -> Iterator[Call]:
    """On a beam; both couplings where it is left open which one it is."""
    from verify.motor import kernels

    for name, beam in (("one-way", None), ("two-way", _beam_answer())):
        if coupling in (name, "auto"):
            feet, log = _ridden()
            before = np.zeros((1, 2))
            yield kernels.ride, (1, 0.0, _surface(), reckoned(), feet, _rubbing(law), beam, _line(), before, log)


def on_chain(law: str) -> Iterator[Call]:
    """On a surface that is given, which does not feel it."""
    return on_springs(law, "one-way")


def hard(law: str) -> Iterator[Call]:
    """A point that lands hard."""
    from verify.motor import hop_kernels

    feet, log = _ridden()
    yield hop_kernels.put, (0.0, _surface(), feet, _rubbing(law), _line())
    point = Hard(1.0, 1.0, 0.0)
    yield hop_kernels.hop, (1, 0.0, _surface(), feet, _rubbing(law), point, _line(), np.zeros((1, 2)), log)


def _ridden() -> tuple[Feet, Log]:
    feet = feet_of((Placed(Slider(mass=1.0, mu=1.0, contact=Contact(stiffness=1.0)), 0.0),))
    return feet, fresh_log(1, feet, np.zeros((0, 1)), 1)


def _rubbing(law: str) -> Rubbing:
    return Rubbing(slope=SLOPES[law], half=0.0)


def _surface() -> Surface:
    drive = Drive(omega=0.0, origin=0.0, unit=1.0, growth=np.zeros(1))
    return Surface(modes=np.zeros((1, 1)), drive=drive, table=np.zeros((1, 1, 1)), edges=np.zeros(2))


def _line() -> Line:
    return Line(local=np.zeros((1, 2, 1)), stamp=np.zeros(1, dtype=np.int64), factors=np.zeros((2, 1)))


def _beam_answer() -> BeamAnswer:
    flat = np.zeros((1, 1))
    return BeamAnswer(answer=flat, load=flat, added=flat, span=np.zeros(2, dtype=np.int64))
