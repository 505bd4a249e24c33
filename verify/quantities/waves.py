"""Named figures of the driven beam: deflection, wave quality, surface ellipses, power."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.quantities import beforehand
from verify.quantities.cases import drive_frequency, driven_beam, driven_case
from verify.quantities.kind import Quantity
from verify.quantities.wave_arguments import (
    At,
    AxisRatio,
    BestFrequency,
    Driven,
    Fastest,
    InWindow,
    Lumped,
    Power,
    Receptance,
    Sensitivity,
    WaveOrder,
)

if TYPE_CHECKING:
    from verify.models.fields import HarmonicField
    from verify.scenes.scene import Scene
    from verify.waves.found import WaveMeasures
    from verify.waves.lumped import TwoModes


def field_of(a: Driven, scene: "Scene", bench: Workbench) -> "HarmonicField":
    """The field that arguments describe. Raises InputError."""
    from verify.waves.driven import driven

    return driven(driven_case(a, scene), bench)


def measured(a: InWindow, scene: "Scene", bench: Workbench) -> "WaveMeasures":
    """The wave measures that arguments describe. Raises InputError."""
    from verify.waves.driven import measures

    return measures(field_of(a, scene, bench), a.window)


def _deflection(a: At, scene: "Scene", bench: Workbench) -> complex:
    return complex(field_of(a, scene, bench).deflection(a.x)[0])


def _slope(a: At, scene: "Scene", bench: Workbench) -> complex:
    return complex(field_of(a, scene, bench).slope(a.x)[0])


def _curvature(a: At, scene: "Scene", bench: Workbench) -> complex:
    return complex(field_of(a, scene, bench).derivative(a.x, 2)[0])


def _axis_ratio(a: AxisRatio, scene: "Scene", bench: Workbench) -> float:
    if a.x is None:
        return _figure("mean_axis_ratio")(a, scene, bench)
    from verify.waves.measures import ellipse, surface_motion

    field = field_of(a, scene, bench)
    return float(ellipse(surface_motion(field.beam, field.turn(a.x), x=a.x), field.deflection(a.x))[0][0])


def _power_imbalance(a: Power, scene: "Scene", bench: Workbench) -> float:
    from verify.waves.driven import power_imbalance

    if any(device.turning for device in scene.devices):
        raise InputError(
            "drive.device: a power balance counts what acts across alone, leave rotational, rotary_inertia and "
            "rotational_dashpot out"
        )
    field = field_of(a, scene, bench)
    return power_imbalance(field, measured(a, scene, bench))


def _best_frequency(a: BestFrequency, scene: "Scene", bench: Workbench) -> float:
    from verify.waves.driven import best_frequency

    return best_frequency(driven_case(a, scene), a.span, a.window, bench)


def _order(a: WaveOrder, scene: "Scene", bench: Workbench) -> float:
    from verify.waves.driven import wave_order

    return wave_order(driven_case(a, scene), a.counts, a.window, a.of, bench)


def _receptance(a: Receptance, scene: "Scene", bench: Workbench) -> complex:
    from verify.waves.unit_waves import receptance

    return receptance(a.model, driven_beam(a, scene), a.position, drive_frequency(a, scene), a.x, a.count, a.theory)


def _sensitivity(name: str) -> Callable[[Sensitivity, "Scene", Workbench], float]:
    """One sensitivity of the operating point at which the scene drives."""

    def evaluate(a: Sensitivity, scene: "Scene", bench: Workbench) -> float:
        from verify.waves.operating_point import driven_point

        return float(getattr(driven_point(driven_case(a, scene)), name))

    return evaluate


def _fastest(a: Fastest, scene: "Scene", bench: Workbench) -> float:
    from verify.waves.operating_point import fastest_point

    return fastest_point(driven_case(a, scene), a.limit).crest_speed


def _two_modes(a: Lumped, scene: "Scene") -> "TwoModes":
    from verify.waves.lumped import TwoModes

    return TwoModes(beam=scene.beam, modes=a.modes, ratio=a.ratio, phase_deg=a.phase_deg)


def _lumped_swr(a: Lumped, scene: "Scene", bench: Workbench) -> float:
    return float(_two_modes(a, scene).local_swr(a.x)[0])


def _needs_two_modes(a: Lumped, scene: "Scene") -> tuple[()]:
    """Raise InputError for a beam that is not uniform, one mode twice, or a place off the beam."""
    from verify.models.places import places

    _two_modes(a, scene)
    places("x", a.x, scene.beam.length)
    return ()


def _figure(name: str) -> Callable[[InWindow, "Scene", Workbench], float]:
    """One of the measures, found without the others."""

    def evaluate(a: InWindow, scene: "Scene", bench: Workbench) -> float:
        from verify.waves.driven import measured_alone

        return float(measured_alone(field_of(a, scene, bench), a.window, name))

    return evaluate


WAVE_QUANTITIES: tuple[Quantity[Any], ...] = (
    Quantity(
        "wave.deflection",
        "m",
        "Complex deflection, e^{+i omega t}.",
        At,
        "harmonic",
        _deflection,
        needs=beforehand.driven,
        devices=True,
    ),
    Quantity(
        "wave.slope",
        "rad",
        "Complex slope of the deflection, e^{+i omega t}, as the model has it.",
        At,
        "harmonic",
        _slope,
        needs=beforehand.driven,
        devices=True,
    ),
    Quantity(
        "wave.curvature",
        "1/m",
        "Complex second derivative of the deflection, as the model has it between its nodes.",
        At,
        "harmonic",
        _curvature,
        needs=beforehand.driven,
        devices=True,
    ),
    Quantity(
        "wave.standing_wave_ratio",
        "1",
        "(1 + Gamma)/(1 - Gamma) of the two waves fitted in the mean square over the window.",
        InWindow,
        "harmonic",
        _figure("standing_wave_ratio"),
        needs=beforehand.driven,
        devices=True,
        superposed="standing_wave_ratio",
    ),
    Quantity(
        "wave.reflection",
        "1",
        "Gamma, the weaker wave over the stronger, at the middle of the window.",
        InWindow,
        "harmonic",
        _figure("reflection"),
        needs=beforehand.driven,
        devices=True,
        superposed="reflection",
    ),
    Quantity(
        "wave.envelope",
        "1",
        "(max - min)/(max + min) of |w| over the window, at any place; Gamma for two waves.",
        InWindow,
        "harmonic",
        _figure("envelope"),
        needs=beforehand.driven,
        devices=True,
    ),
    Quantity(
        "wave.travelling_index",
        "1",
        "1/cond([Re w, Im w]) over the window's whole half wavelengths: (1 - Gamma)/(1 + Gamma) for two waves.",
        InWindow,
        "harmonic",
        _figure("travelling_index"),
        needs=beforehand.driven,
        devices=True,
    ),
    Quantity(
        "wave.axis_ratio",
        "1",
        "Signed axis ratio of the surface ellipse at x, else the mean over whole half waves; below 0 towards +x.",
        AxisRatio,
        "harmonic",
        _axis_ratio,
        needs=beforehand.driven,
        devices=True,
    ),
    Quantity(
        "wave.signed_area_spread",
        "1",
        "(max - min)/|mean| of the ellipses' signed area over the window, at any place.",
        InWindow,
        "harmonic",
        _figure("signed_area_spread"),
        needs=beforehand.driven,
        devices=True,
    ),
    Quantity(
        "wave.crest_speed",
        "m/s",
        "Speed of the surface at the crests, along +x.",
        InWindow,
        "harmonic",
        _figure("crest_speed"),
        needs=beforehand.driven,
        devices=True,
        superposed="crest_speed",
    ),
    Quantity(
        "wave.energy_flux",
        "W",
        "Power carried towards +x through the middle of the window by the two waves that fit it.",
        InWindow,
        "harmonic",
        _figure("energy_flux"),
        needs=beforehand.driven,
        devices=True,
        superposed="energy_flux",
    ),
    Quantity(
        "wave.power_imbalance",
        "1",
        "Input of the left force less losses less flux, up to the window's middle.",
        Power,
        "harmonic",
        _power_imbalance,
        needs=beforehand.driven,
        devices=True,
    ),
    Quantity(
        "wave.best_frequency",
        "Hz",
        "Frequency of least reflection near the drive's, all else as it is.",
        BestFrequency,
        "harmonic",
        _best_frequency,
        needs=beforehand.driven,
        devices=True,
    ),
    Quantity(
        "wave.order",
        "1",
        "Observed order of a wave figure's error against the exact field, refused where it is not settled.",
        WaveOrder,
        "harmonic",
        _order,
        needs=beforehand.driven,
        devices=True,
    ),
    Quantity(
        "wave.lumped_swr",
        "1",
        "Local standing-wave ratio of two modes that swing with a phase between them: the lumped picture of the wave.",
        Lumped,
        "closed form",
        _lumped_swr,
        needs=_needs_two_modes,
        devices=True,
    ),
    Quantity(
        "wave.receptance",
        "m/N",
        "Deflection at one place under a unit force at another, by all modes at once.",
        Receptance,
        "harmonic",
        _receptance,
        needs=beforehand.at_frequency,
    ),
    Quantity(
        "wave.reflection_per_hertz",
        "1/Hz",
        "Change of the reflection over half a hertz, mean of both sides.",
        Sensitivity,
        "harmonic",
        _sensitivity("per_hertz"),
        needs=beforehand.driven,
    ),
    Quantity(
        "wave.reflection_per_degree",
        "1/degree",
        "Change over half a degree of phase, mean of both sides.",
        Sensitivity,
        "harmonic",
        _sensitivity("per_degree"),
        needs=beforehand.driven,
    ),
    Quantity(
        "wave.fastest_crests",
        "m/s",
        "Largest surface speed at the crests within 1.5 % of the drive's frequency and between phases of 5 and 175 "
        "degrees, with a reflection up to `limit`; that at the edge of these where it grows beyond.",
        Fastest,
        "harmonic",
        _fastest,
        needs=beforehand.driven,
    ),
)
