"""Which compiled loops a figure runs, for whoever compiles them ahead of it (`models.ahead`).

Each is a quantity's `kernels`: calls with values of the right kinds, in order of need.
"""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from verify.models.compiling import Call

if TYPE_CHECKING:
    from verify.quantities.chain_arguments import Departing, FromRest, Ridden
    from verify.quantities.motion_arguments import SliderInTime
    from verify.quantities.motor_arguments import Motor
    from verify.scenes.scene import Scene

Calls = Callable[[Any, "Scene"], Iterator[Call]]


def on_belt(law: str) -> Calls:
    """Friction by one law on a surface of constant speed."""

    def kernels(a: Any, scene: "Scene") -> Iterator[Call]:
        from verify.motion import warm

        return warm.on_belt(law)

    return kernels


def on_wave(a: Any, scene: "Scene") -> Iterator[Call]:
    """A slider under tanh friction on a pure wave, which does not feel it."""
    from verify.motion import warm

    return warm.on_beam("tanh", "one-way")


def slid(a: "SliderInTime", scene: "Scene") -> Iterator[Call]:
    """The scene's slider on a beam, with what is given instead. Raises InputError where there is none."""
    from verify.motion import warm
    from verify.quantities.simulated import slider_of

    slider = slider_of(a, scene)
    return warm.on_beam(slider.law, slider.coupling)


def ridden(a: "Ridden", scene: "Scene") -> Iterator[Call]:
    """The scene's slider on a nonlinear chain. Raises InputError where there is none."""
    from verify.chain import warm
    from verify.motion.warm import on_chain
    from verify.quantities.simulated import slider_of

    law = slider_of(a, scene).law
    yield from warm.rigid() if a.links == "rigid" else warm.stretching()
    yield from on_chain(law)


def motor(a: "Motor", scene: "Scene") -> Iterator[Call]:
    """The scene's slider on feet on a steady beam. Raises InputError where there is none."""
    from verify.motor import warm
    from verify.quantities.motor_arguments import slider_on_feet

    return warm.on_beam(slider_on_feet(a, scene))


def over_wave(a: Any, scene: "Scene") -> Iterator[Call]:
    """A foot under Coulomb's friction on a pure wave, which does not feel it."""
    from verify.motor import warm

    return warm.on_springs("coulomb", "one-way")


def stepped(a: Any, scene: "Scene") -> Iterator[Call]:
    """A chain of rigid links in steps."""
    from verify.chain import warm

    return warm.rigid()


def transient(a: "FromRest", scene: "Scene") -> Iterator[Call]:
    """A driven chain by the method that is asked for."""
    from verify.chain import warm

    return warm.modal() if a.method in ("modal", "linear") else warm.rigid()


def departing(a: "Departing", scene: "Scene") -> Iterator[Call]:
    """A chain of rigid or of stretching links."""
    from verify.chain import warm

    return warm.stretching() if a.inertia == "elastic" else warm.rigid()
