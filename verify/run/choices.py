"""How a slider is coupled and whether the chain may be linear, by size: what `plan` says of a slider's run."""

from typing import TYPE_CHECKING

from msgspec.structs import replace

from verify.beam import PointForce
from verify.errors import InputError
from verify.models.catalogue import MODELS
from verify.models.underfoot import standing_at
from verify.motion.contact import FELT, coupling_of, surface_speed
from verify.motion.turning import couple, turned_by
from verify.motion.validity import NONLINEAR, field_size

if TYPE_CHECKING:
    from verify.beam import Beam
    from verify.models.fields import HarmonicField
    from verify.scenes.scene import Scene
    from verify.slider import Slider


def slider_choices(scene: "Scene") -> list[tuple[str, str]]:
    """(what was chosen, why) of the exact beam's field; nothing where that has none."""
    assert scene.drive is not None
    assert scene.slider is not None
    exact = MODELS["analytic"]
    try:
        field = exact.solve_harmonic(_damped(scene), scene.forces, scene.drive.frequency_hz, None)
    except InputError:
        return []
    return [*_coupling(scene.slider, field), _linear(field)]


def _damped(scene: "Scene") -> "Beam":
    """The beam with what stands in for its loss factor in time: twice the ratio of every mode."""
    ratio = scene.motion.modal_damping if scene.motion else None
    return scene.beam if ratio is None else replace(scene.beam, loss_factor=2.0 * ratio)


def _coupling(slider: "Slider", field: "HarmonicField") -> list[tuple[str, str]]:
    """One-way or two-way, and that a slider without normal inertia is a simplification."""
    x, exact, frequency = slider.start_on(field.beam), MODELS["analytic"], field.frequency_hz
    unit = exact.solve_harmonic(field.beam, (PointForce(position=x),), frequency, None)
    turned = exact.solve_harmonic(field.beam, couple(field.beam, x, frequency), frequency, None)
    yields = complex(unit.deflection([x])[0]), turned_by(turned, x)
    if slider.contact is not None:
        return [_on_feet(slider, field, *yields)]
    found = coupling_of(slider, standing_at(field.beam, x), frequency, surface_speed(field, x), *yields)
    why = ", as slider.coupling says" if found.forced else f" (felt from {FELT:g} on)"
    chosen = [(f"{'two' if found.two_way else 'one'}-way coupling", found.told + why)]
    return chosen + ([("slider that the beam does not carry", found.simplified)] if found.simplified else [])


def _on_feet(slider: "Slider", field: "HarmonicField", receptance: complex, turning: complex) -> tuple[str, str]:
    """The same of a slider that may leave the beam."""
    from verify.motor.coupling import coupled, in_words, sizes

    x = slider.start_on(field.beam)
    moved, turned = float(abs(field.deflection([x])[0])), float(abs(field.slope([x])[0]))
    beam = standing_at(field.beam, x)
    found = coupled(slider, *sizes(slider, beam, field.omega, moved, turned, receptance, turning))
    why = ", as slider.coupling says" if found.forced else f" (felt from {FELT:g} on)"
    return f"slider that may leave the beam, {'two' if found.two_way else 'one'}-way", in_words(found) + why


def _linear(field: "HarmonicField") -> tuple[str, str]:
    """A slider's run is on the linear chain whatever the size, which is said."""
    size = field_size(field)
    linear = "linear chain with an exact step" if size <= NONLINEAR else "linear chain, although"
    what = "axial inertia of a roller-ended chain, (kL)^2 <theta^2>"
    return linear, f"{what} = {size:.1e} of the motion (felt from {NONLINEAR:g} on)"
