"""Which kernels a scene is likely to ask for, for whoever compiles them ahead of it.

A guess: one that is left out is compiled when it is asked for, and one too many is ended with the run.
"""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from verify.run.asks import asks_of

if TYPE_CHECKING:
    from verify.scenes.scene import Scene
    from verify.slider import Slider

Call = tuple[Callable[..., Any], tuple[Any, ...]]
"""A kernel and what it is called with."""


def kernels_asked(scene: "Scene") -> Iterator[Call]:
    """In order of need: friction by itself, the slider on the beam, chains that carry it or move alone."""
    from verify.chain import warm as chain
    from verify.motion import warm as motion

    in_time = [ask for ask in asks_of(scene) if ask.work in ("in time", "equilibrium") and not ask.problem]
    carried = any(ask.slides for ask in in_time)
    alone = any(not ask.slides for ask in in_time)
    if scene.slider and scene.slider.contact is not None and carried:
        yield from _motors(scene.slider, getattr(getattr(scene, "motor", None), "models", ()))
        return
    if scene.slider and carried:
        if alone:
            yield from motion.on_belt()
        yield from motion.on_beam(scene.slider.law, scene.slider.coupling)
    if alone:
        yield from chain.rigid()
        yield from motion.on_chain(scene.slider.law) if scene.slider and carried else chain.modal()
        yield from chain.stretching()


def _motors(slider: "Slider", models: tuple[str, ...]) -> Iterator[Call]:
    """Those of a slider that may leave the beam, and of the nonlinear chain where it is among the motor's fields."""
    from verify.chain import warm as chain
    from verify.motor import warm
    from verify.motor.combine import CHAIN

    assert slider.contact is not None
    yield from warm.hard(slider.law) if slider.contact.hard else warm.on_springs(slider.law, slider.coupling)
    if CHAIN in models:
        yield from chain.rigid()
        yield from warm.on_chain(slider.law)
        yield from chain.stretching()
