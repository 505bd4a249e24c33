"""Simulations that arguments and a scene describe, kept on the bench."""

from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from verify.errors import InputError
from verify.motion import Motion
from verify.simulate import simulate
from verify.slider import Slider
from verify.waves import drive_forces, drive_frequency

if TYPE_CHECKING:
    from verify.scene import Scene
    from verify.workbench import Workbench

_OWN = {"mu": "mu", "slope": "slope", "mass": "mass", "law": "law", "coupling": "coupling", "line": "line",
        "kinematics": "kinematics", "slider_position": "position", "slider_speed": "speed"}  # fmt: skip


def slider_of(a: Any, scene: "Scene") -> Slider:
    """The scene's slider with what is given instead. Raises InputError where there is none."""
    if scene.slider is None:
        raise InputError("the scene has no slider: add [slider] with mass and mu")
    given = {own: getattr(a, name) for name, own in _OWN.items() if getattr(a, name) is not None}
    return replace(scene.slider, **given)


def described(a: Any, scene: "Scene") -> dict[str, Any]:
    """Keyword arguments of `simulate` other than slider, points and samples. Raises InputError."""
    motion = scene.motion
    time = a.time if a.time is not None else (motion.duration if motion else None)
    if time is None:
        raise InputError("time is missing and the scene has no [motion]: give time in seconds")
    if scene.drive is not None and scene.drive.kind != "force":
        raise InputError(f"drive.kind = {scene.drive.kind!r}: motion in time takes imposed forces, give kind = 'force'")
    start = a.start or (motion.start if motion else "rest")
    soft = a.soft_start_periods
    if soft is None:
        soft = motion.soft_start_periods if motion and start == "rest" else 0.0
    damping = a.modal_damping if a.modal_damping is not None else (motion.modal_damping if motion else None)
    return {
        "forces": drive_forces(a, scene), "frequency_hz": drive_frequency(a, scene), "duration": time, "model": a.model,
        "count": a.count, "modes": a.modes, "start": start, "soft_start_periods": soft, "modal_damping": damping,
    }  # fmt: skip


def with_slider(a: Any, scene: "Scene", bench: "Workbench", samples: int = 2, ledger: bool = False) -> Motion:
    """The slider's run, solved once. Raises InputError where it does not reach its end."""
    asked, slider = described(a, scene), slider_of(a, scene)
    step = a.step
    if step is None and scene.motion is not None:
        step = 1.0 / (scene.motion.steps_per_period * asked["frequency_hz"])
    key = ("slider", scene.beam, slider, step, samples, ledger, *asked.values())
    if key not in bench.motions:
        bench.motions[key] = simulate(
            scene.beam, slider=slider, step=step, samples=samples, ledger=ledger, progress=bench.tell, patient=False,
            **asked,
        )  # fmt: skip
    found: Motion = bench.motions[key]
    if found.statistics.stopped == "interrupted":
        raise KeyboardInterrupt
    if found.statistics.stopped != "end":
        raise InputError(
            f"the slider {found.statistics.stopped} after {found.end.time:.6g} s of {asked['duration']!r} s: "
            "shorten time or start it elsewhere"
        )
    return found


def without_slider(a: Any, scene: "Scene", bench: "Workbench") -> Motion:
    """The beam alone at the times 0 and `time`, at x."""
    asked = described(a, scene)
    key = ("beam", scene.beam, a.x, *asked.values())
    if key not in bench.motions:
        bench.motions[key] = simulate(scene.beam, at=[a.x], samples=2, ledger=False, **asked)
    found: Motion = bench.motions[key]
    return found


def slider_order(a: Any, scene: "Scene", bench: "Workbench") -> float:
    """Observed order of the slider's displacement. Raises InputError.

    Over counts against the exact beam, over steps against one sixteen times finer than the finest.
    """
    from verify.compare import observed_order, relative_error

    def displacement(**other: Any) -> float:
        return with_slider(replace(a, counts=None, steps=(1.0,), **other), scene, bench).displacement

    if a.counts is not None:
        exact = displacement(model="analytic", count=None)
        return observed_order(a.counts, [abs(relative_error(displacement(count=n), exact)) for n in a.counts])
    exact = displacement(step=min(a.steps) / 16.0)
    errors = [abs(relative_error(displacement(step=dt), exact)) for dt in a.steps]
    return observed_order([round(max(a.steps) / dt * 1e6) for dt in a.steps], errors)
