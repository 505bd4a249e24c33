"""The steady field under the scene's drive: segments, elements, and the closed form that both are against."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from verify.bench.kind import ASKED_OF_PARTS, Case, Entry, Judged, Line, Reference, Told, orders_of_fields
from verify.bench.request import Settled
from verify.errors import InputError
from verify.models.arrays import Array, ComplexArray
from verify.models.catalogue import MODELS, discrete
from verify.models.kind import Model
from verify.timing import forget

if TYPE_CHECKING:
    from verify.beam import PointForce
    from verify.models.fields import HarmonicField
    from verify.scenes.scene import Scene

PLACES = 201
"""Evenly over the beam, where a field is read while it is timed."""
EACH = 8
"""Places to a part at which it is judged, at least as many as those: what one part alone leaves shows at many parts."""
TURN = 1e-7
"""Relative, of the frequency: how a field's sensitivity to its rounding is found."""
ROUNDINGS = 8.0 * np.finfo(float).eps
FIELD_S, FIELD_PER_PART_S = 1e-2, 1e-4
"""Of a field, from above."""


def forces_of(scene: "Scene", name: str) -> tuple["PointForce", ...]:
    """The scene's driving forces. Raises InputError where there are none, or displacements."""
    if scene.drive is None or not any(force.amplitude for force in scene.forces):
        raise InputError(f"{name}: nothing drives the beam, give the scene a [drive] with forces above 0")
    scene.refuse_devices(name)
    if scene.drive.kind != "force":
        raise InputError(f"{name}: drive.kind = {scene.drive.kind!r}, and benches take imposed forces: give 'force'")
    return scene.forces


def field_cases(scene: "Scene", its: Settled) -> Iterator[Case]:
    """The one. Raises InputError."""
    forces = forces_of(scene, "harmonic")
    assert scene.drive is not None
    beam, frequency, x = scene.beam, scene.drive.frequency_hz, np.linspace(0.0, scene.beam.length, PLACES)
    able = discrete("solve_harmonic", beam)

    def prepare(model: Model, count: int | None) -> Callable[[], Told]:
        """The next field on a model that has had one: what models keep of themselves is set-up."""
        forget()

        def run() -> Told:
            field = model.solve_harmonic(beam, forces, frequency, count)
            field.deflection(x)
            return Told(field)

        run()
        return run

    def entry(model: Model, count: int | None) -> Entry:
        orders = orders_of_fields(model, beam) if count else None
        return Entry(
            line=Line(name=model.title, model=model.name, orders=orders),
            size=1.0 / count if count else 0.0,
            count=count,
            estimate_s=FIELD_S + FIELD_PER_PART_S * (count or 0),
            prepare=partial(prepare, model, count),
            sets_up=True,
            runs_first=True,
        )

    def exact(turn: float) -> "HarmonicField":
        return MODELS["analytic"].solve_harmonic(beam, forces, frequency * (1.0 + turn), None)

    yield Case(
        set="harmonic",
        question="deflection, rms over the beam",
        condition=f"the steady field under the scene's drive at {frequency:g} Hz"
        + (f", loss factor {beam.loss_factor:g}" if beam.loss_factor else ", undamped"),
        entries=(*(entry(model, n) for model in able for n in its.counts), entry(MODELS["analytic"], None)),
        pairs=tuple((able[0].title, model.title) for model in able[1:]),
        judge=lambda: _against(exact),
        wanted=ASKED_OF_PARTS,
    )


def _against(exact: Callable[[float], "HarmonicField"]) -> Callable[[Entry, Any], Judged]:
    """The closed form, and what rounding its frequency makes of it. Raises InputError."""
    still, turned = exact(0.0), exact(TURN)
    x = np.linspace(0.0, still.beam.length, PLACES)
    if not abs(still.deflection(x)).any():
        raise InputError("harmonic: the exact beam stands still, change the drive")
    sensitivity = relative_rms(turned.deflection(x), still.deflection(x)) / TURN
    reference = Reference("exact field in closed form, rounding of its frequency", float(ROUNDINGS * sensitivity))

    def judge(entry: Entry, answer: "HarmonicField") -> Judged:
        x = np.linspace(0.0, still.beam.length, max(EACH * (entry.count or 0) + 1, PLACES))
        return Judged(relative_rms(answer.deflection(x), still.deflection(x)), reference)

    return judge


def relative_rms(found: Array | ComplexArray, exact: Array | ComplexArray) -> float:
    """Rms of a difference over the rms of what is exact; infinite where a value is not finite."""
    if not np.isfinite(found).all():
        return float("inf")
    return float(np.sqrt(np.mean(abs(found - exact) ** 2) / np.mean(abs(exact) ** 2)))
