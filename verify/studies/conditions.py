"""How a scene's own slider is run on a model: what stands beside every figure of it."""

from typing import TYPE_CHECKING

from verify.motion.figures import CHAIN, Condition

if TYPE_CHECKING:
    from verify.scenes.scene import Scene
    from verify.slider import Slider


def _normal_in(model: str, slider: "Slider") -> str:
    """Whether the slider is held on this model's surface, and whether that is fed back."""
    if model == CHAIN or slider.normal == "massless":
        return "massless"
    return "held, one-way," if slider.coupling == "one-way" else "held"


def condition_of(scene: "Scene", model: str, count: int | None) -> Condition:
    """How the scene's own slider is run on a model."""
    slider, asked = scene.slider, scene.motion
    assert slider is not None
    assert asked is not None
    return Condition(
        kinematics=slider.kinematics,
        normal=_normal_in(model, slider),
        start=asked.start,
        soft_start_periods=asked.soft_start,
        forces=tuple(force.amplitude for force in scene.forces),
        law=slider.law,
        mu=slider.mu,
        slope=slider.steepness,
        position=slider.start_on(scene.beam),
        model=model,
        count=count,
        duration=asked.duration,
    )
