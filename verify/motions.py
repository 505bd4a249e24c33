"""Simulations that arguments and a scene describe, kept on the bench."""

from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from verify.errors import InputError
from verify.motion import Motion
from verify.motion_arguments import SliderInTime
from verify.simulate import simulate
from verify.slider import Slider
from verify.waves import drive_forces, drive_frequency

if TYPE_CHECKING:
    from verify.scene import Scene
    from verify.workbench import Workbench

MODES = 400
"""Of the exact beam from rest, unless asked for otherwise."""
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
        "count": a.count, "modes": a.modes or MODES, "start": start, "soft_start_periods": soft,
        "modal_damping": damping,
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
            scene.beam, slider=slider, step=step, samples=samples, ledger=ledger, progress=bench.tell, **asked
        )
    found: Motion = bench.motions[key]
    if found.statistics.stopped == "interrupted":
        raise KeyboardInterrupt
    if found.statistics.stopped != "end":
        raise InputError(
            f"the slider {found.statistics.stopped} after {found.end.time:.6g} s of {asked['duration']!r} s: "
            "shorten time or start it elsewhere"
        )
    _check_modes(a, asked["start"], bool(found.coupling and found.coupling.two_way))
    return found


def _check_modes(a: Any, start: str, felt: bool) -> None:
    """Raise InputError for a number of modes where no mode is taken."""
    if a.modes is not None and start == "steady" and not felt:
        raise InputError(f"modes = {a.modes!r}: a steady beam that feels no slider is one field, leave it out")


def without_slider(a: Any, scene: "Scene", bench: "Workbench") -> Motion:
    """The beam alone at the times 0 and `time`, at x."""
    asked = described(a, scene)
    _check_modes(a, asked["start"], felt=False)
    key = ("beam", scene.beam, a.x, *asked.values())
    if key not in bench.motions:
        bench.motions[key] = simulate(scene.beam, at=[a.x], samples=2, ledger=False, **asked)
    found: Motion = bench.motions[key]
    return found


def slider_order(a: Any, scene: "Scene", bench: "Workbench") -> float:
    """Observed order of the slider's displacement. Raises InputError.

    Over counts against the exact beam, over steps against one sixteen times finer than the finest.
    """
    from verify.compare import observed_order

    given = {name: getattr(a, name) for name in SliderInTime.__struct_fields__}

    def displacement(**other: Any) -> float:
        return with_slider(SliderInTime(**{**given, **other}), scene, bench).displacement

    if a.counts is not None:
        exact = displacement(model="analytic", count=None)
        found = [displacement(count=n, modes=None) for n in a.counts]
        return observed_order(a.counts, [abs(one - exact) / abs(exact) for one in found])
    exact = displacement(step=min(a.steps) / 16.0)
    errors = [abs(displacement(step=dt) - exact) / abs(exact) for dt in a.steps]
    return observed_order([round(max(a.steps) / dt * 1e6) for dt in a.steps], errors)
