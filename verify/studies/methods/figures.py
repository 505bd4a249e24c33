"""Both ways of driving for a table and a report: over frequency, load and detuning, along the beam, under a slider."""

from contextlib import suppress
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.beam import Beam
from verify.device import Device
from verify.errors import ResonanceError
from verify.exact.closed_forms import frequency_hz
from verify.models.catalogue import discrete
from verify.motion.validity import nearest_mode
from verify.studies.chart import Chart
from verify.studies.kind import Progress
from verify.studies.methods.seen import WAYS, Row, Setting, Way, seen_of, setting_of
from verify.studies.told import Found, Table
from verify.units import in_words, time_in_words, unit_of
from verify.waves.driven import driven, measures
from verify.waves.lumped import TwoModes, local_swr

if TYPE_CHECKING:
    from verify.judge.workbench import Workbench
    from verify.models.fields import HarmonicField
    from verify.motion.result import Motion
    from verify.motor.result import MotorRun
    from verify.scenes.scene import Scene
    from verify.slider import Slider
    from verify.studies.methods.study import Methods

ALONG = 401
"""Places at which the local standing-wave ratio is read along the beam."""
TAIL = 0.5
"""Of a slider's run, its end, over which its speed is averaged: the start is over by then."""


class Ride(msgspec.Struct, frozen=True, kw_only=True):
    """Mean speed of the slider at one frequency, m/s along +x, both ways; None on a resonance of the bare beam."""

    off_hz: float
    device: float | None
    forces: float | None


class ByModel(msgspec.Struct, frozen=True, kw_only=True):
    """Standing-wave ratios of one model at the drive, both ways, in the middle half."""

    model: str
    count: int | None
    device: float
    forces: float


def row_of(setting: Setting, bench: "Workbench", what: str, value: float, **condition: Any) -> Row:
    """Both ways in one condition of frequency or load."""
    found = {way: seen_of(setting, setting.case(way, **condition), bench) for way in WAYS}
    return Row(what=what, value=value, device=found["device"], forces=found["forces"])


def over_frequency(setting: Setting, asked: "Methods", bench: "Workbench") -> tuple[Row, ...]:
    """Evenly from below to above the drive."""
    steps = np.linspace(-asked.span_hz, asked.span_hz, asked.steps)
    return tuple(row_of(setting, bench, "frequency", float(off), off_hz=float(off)) for off in steps)


def at_edges(setting: Setting, asked: "Methods", bench: "Workbench") -> tuple[Row, ...]:
    """As driven, and at both ends of the span."""
    words = {
        0.0: "as driven",
        -asked.span_hz: f"{asked.span_hz:g} Hz below",
        asked.span_hz: f"{asked.span_hz:g} Hz above",
    }
    return tuple(row_of(setting, bench, what, off, off_hz=off) for off, what in words.items())


def over_load(setting: Setting, asked: "Methods", bench: "Workbench") -> tuple[tuple[Row, ...], tuple[Row, ...]]:
    """(masses, dashpots) on the beam at one place."""
    at = load_place(setting, asked)
    masses = [Device(position=at, mass=mass) for mass in asked.load_mass]
    brakes = [Device(position=at, dashpot=dashpot) for dashpot in asked.load_dashpot]
    return (
        tuple(row_of(setting, bench, in_words(1e3 * load.mass, "g", "g"), load.mass, load=load) for load in masses),
        tuple(row_of(setting, bench, f"{load.dashpot:g} N s/m", load.dashpot, load=load) for load in brakes),
    )


def load_place(setting: Setting, asked: "Methods") -> float:
    """Where the load is, metres."""
    middle = 0.5 * (setting.force.position + setting.device.position)
    return middle if asked.load_position is None else asked.load_position


class Detuned(msgspec.Struct, frozen=True, kw_only=True):
    """What is left where one thing is off by a factor and all else as it was; None where there is nothing to be off."""

    factor: float
    dashpot: float | None
    reactance: float | None
    """Spring and mass of the device."""
    force: float | None
    """The second force."""


def over_detuning(setting: Setting, asked: "Methods", bench: "Workbench") -> tuple[Detuned, ...]:
    """Reflections with the device's dashpot, its spring and mass, or the second force off by each factor."""

    def left(changed: Setting, way: Way) -> float | None:
        found = seen_of(changed, changed.case(way), bench)
        return found.reflection if found else None

    rows = []
    for s in asked.factors:
        own, second = setting.device, setting.second
        braked = replace(own, dashpot=s * own.dashpot)
        sprung = replace(own, stiffness=s * own.stiffness, mass=s * own.mass)
        pushed = replace(second, amplitude=s * second.amplitude)
        rows.append(
            Detuned(
                factor=s,
                dashpot=left(replace(setting, device=braked), "device") if own.dashpot else None,
                reactance=left(replace(setting, device=sprung), "device") if own.stiffness or own.mass else None,
                force=left(replace(setting, second=pushed), "forces"),
            )
        )
    return tuple(rows)


def by_model(setting: Setting, asked: "Methods", bench: "Workbench") -> tuple[ByModel, ...]:
    """Every model at the drive, by waves fitted in the middle half."""
    sizes = {"analytic": None} | {m.name: asked.count for m in discrete("solve_harmonic", setting.beam)}
    rows = []
    for model, count in sizes.items():
        cases = {way: replace(setting.case(way), model=model, count=count) for way in WAYS}
        ratios = {way: measures(driven(case, bench), None).standing_wave_ratio for way, case in cases.items()}
        rows.append(ByModel(model=model, count=count, device=ratios["device"], forces=ratios["forces"]))
    return tuple(rows)


class Along(msgspec.Struct, frozen=True, kw_only=True):
    """Along the beam between force and device: amplitudes, and local standing-wave ratios of fields and picture."""

    x: tuple[float, ...]
    """Metres."""
    amplitudes: dict[str, tuple[float, ...]]
    """|w| of the exact field, metres, over the whole beam (`everywhere`), by way."""
    everywhere: tuple[float, ...]
    ratios: dict[str, tuple[float, ...]]
    """By way."""
    lumped: tuple[float, ...]
    modes: tuple[int, int]
    """Of the picture."""


def along(setting: Setting, asked: "Methods", bench: "Workbench") -> Along:
    """Both fields at the drive and the lumped picture."""
    pair = asked.modes or neighbours(setting.beam, setting.hertz)
    low, high = sorted((setting.force.position, setting.device.position))
    x, everywhere = np.linspace(low, high, ALONG + 2)[1:-1], np.linspace(0.0, setting.beam.length, ALONG)
    fields = {way: driven(setting.case(way), bench) for way in WAYS}
    picture = TwoModes(beam=setting.beam, modes=pair)
    return Along(
        x=tuple(x.tolist()),
        everywhere=tuple(everywhere.tolist()),
        amplitudes={way: tuple(abs(field.deflection(everywhere)).tolist()) for way, field in fields.items()},
        ratios={way: tuple(local_swr(f, x).tolist()) for way, f in fields.items()},
        lumped=tuple(picture.local_swr(x).tolist()),
        modes=pair,
    )


def neighbours(beam: Beam, hertz: float) -> tuple[int, int]:
    """The modes whose frequencies a drive lies between; the lowest two below the first."""
    near = nearest_mode(beam, hertz)
    lower = near if frequency_hz(beam, near) <= hertz else near - 1
    lower = max(lower, 1)
    return lower, lower + 1


def _resonances(setting: Setting) -> tuple[tuple[int, float], tuple[int, float]]:
    lower, upper = neighbours(setting.beam, setting.hertz)
    return (lower, frequency_hz(setting.beam, lower)), (upper, frequency_hz(setting.beam, upper))


class MethodsFound(Found, frozen=True, eq=False, kw_only=True):
    """Everything the report shows of both ways of driving."""

    edges: tuple[Row, ...]
    """As driven, below, above."""
    frequencies: tuple[Row, ...]
    masses: tuple[Row, ...]
    dashpots: tuple[Row, ...]
    detuned: tuple[Detuned, ...]
    models: tuple[ByModel, ...]
    along: Along
    picture: tuple[tuple[float, float, float], ...]
    """(x in metres, lumped, field of two forces): at L/4, L/2, 3L/4 as far as they lie between force and device."""
    rides: tuple[Ride, ...]
    slider: str
    """How the slider was run; empty without one."""
    resonances: tuple[tuple[int, float], tuple[int, float]]
    """(mode, Hz) of the bare beam on either side of the drive."""
    hertz: float
    span_hz: float
    force: float
    """Newton, of each actuator."""
    phase_deg: float
    places: tuple[float, float]
    """Of force and device, metres."""
    load_position: float
    damping: str
    count: int

    def at(self, place: float) -> str:
        """A place in the unit in which the beam is drawn: '125 mm'."""
        unit = unit_of(self.along.everywhere[-1])
        return f"{unit.factor * place:g} {unit.name}"

    @property
    def read_at(self) -> float:
        """Metres: where reflections are read without a load, halfway from the force to the middle of both."""
        start, end = self.places
        return 0.75 * start + 0.25 * end

    def in_short(self) -> str:
        """The first of the facts."""
        from verify.studies.methods.told import short

        return short(self)

    def facts(self) -> tuple[str, ...]:
        """Each with the condition that it was computed for."""
        from verify.studies.methods.told import facts

        return facts(self)

    def tables(self) -> tuple[Table, ...]:
        """Side by side; under load; by each model; the lumped picture."""
        from verify.studies.methods.told import tables

        return tables(self)

    def charts(self) -> tuple[Chart, ...]:
        """Over frequency, detuning and load, along the beam."""
        from verify.studies.methods.charts import methods_charts

        return methods_charts(self)

    def motions(self) -> int:
        """Both of each ride, but for resonances."""
        return sum(speed is not None for ride in self.rides for speed in (ride.device, ride.forces))


def methods_study(
    scene: "Scene", bench: "Workbench", asked: "Methods", progress: Progress = lambda step: None
) -> MethodsFound:
    """Everything a [methods] of a scene asks for. Raises InputError."""
    setting = setting_of(scene, asked)
    progress("over frequency")
    edges, frequencies = at_edges(setting, asked, bench), over_frequency(setting, asked, bench)
    progress("detuning and load")
    detuned, (masses, dashpots) = over_detuning(setting, asked, bench), over_load(setting, asked, bench)
    progress(f"every model, N = {asked.count}")
    models = by_model(setting, asked, bench)
    progress("along the beam")
    found = along(setting, asked, bench)
    rides, words = _rides(scene, setting, asked, bench, progress) if scene.slider else ((), "")
    eta = scene.beam.loss_factor
    return MethodsFound(
        edges=edges,
        frequencies=frequencies,
        masses=masses,
        dashpots=dashpots,
        detuned=detuned,
        models=models,
        along=found,
        picture=_picture(setting, found.modes, bench),
        rides=rides,
        slider=words,
        resonances=_resonances(setting),
        hertz=setting.hertz,
        span_hz=asked.span_hz,
        force=setting.force.amplitude,
        phase_deg=asked.phase_deg,
        places=(setting.force.position, setting.device.position),
        load_position=load_place(setting, asked),
        damping=f"loss factor {eta:g}" if eta else "undamped",
        count=asked.count,
    )


def _picture(setting: Setting, modes: tuple[int, int], bench: "Workbench") -> tuple[tuple[float, float, float], ...]:
    low, high = sorted((setting.force.position, setting.device.position))
    x = np.array([part * setting.beam.length for part in (0.25, 0.5, 0.75) if low < part * setting.beam.length < high])
    field = local_swr(driven(setting.case("forces"), bench), x)
    lumped = TwoModes(beam=setting.beam, modes=modes).local_swr(x)
    return tuple(zip(x.tolist(), lumped.tolist(), field.tolist(), strict=True))


def _rides(
    scene: "Scene", setting: Setting, asked: "Methods", bench: "Workbench", progress: Progress
) -> tuple[tuple[Ride, ...], str]:
    """The slider on both at the drive and at both ends of the span, and how it was run."""
    progress("slider")
    rides = []
    for off in (-asked.span_hz, 0.0, asked.span_hz):
        speeds: dict[Way, float | None] = dict.fromkeys(WAYS)
        for way in WAYS:
            with suppress(ResonanceError):
                speeds[way] = slider_speed(scene, driven(setting.case(way, off_hz=off), bench), asked.duration)
        rides.append(Ride(off_hz=off, device=speeds["device"], forces=speeds["forces"]))
    slider = scene.slider
    assert slider is not None
    law = "Coulomb" if slider.steepness is None else f"K = {slider.steepness:g} s/m"
    kind = f"always on the surface, one-way, {slider.kinematics} kinematics"
    if slider.contact is not None:
        kind = f"free to leave the surface, one-way, pressed on with {slider.normal_force:.4g} N"
    return tuple(rides), (
        f"{kind}, mu = {slider.mu:g}, {law}, "
        f"from x = {slider.start_on(scene.beam):g} m, mean of the last {time_in_words(TAIL * asked.duration)} of "
        f"{time_in_words(asked.duration)} in the steady state"
    )


def slider_speed(scene: "Scene", field: "HarmonicField", duration: float) -> float:
    """Mean speed of the scene's slider on a steady field, m/s along +x, over whole periods at the end of its run.

    The field's forces hold what the devices do across, so that the bare beam under them is the beam with its devices,
    as long as the slider does not push back. A slider that does wants the devices in time. Raises InputError.
    """
    assert scene.slider is not None
    slider = replace(scene.slider, coupling="one-way")
    periods = max(round(duration * field.frequency_hz), 2)
    motion = _ridden(slider, field, periods)
    times, way, late = motion.times, motion.travelled, int((1.0 - TAIL) * periods)
    return float((way[-1] - way[late]) / (times[-1] - times[late]))


def _ridden(slider: "Slider", field: "HarmonicField", periods: int) -> "Motion | MotorRun":
    """The slider's run on a steady field that does not feel it, sampled once a period."""
    from verify.motion.simulate import simulate
    from verify.motor.run import run_motor

    beam, hertz, samples = field.beam, field.frequency_hz, periods + 1
    if slider.contact is not None:
        return run_motor(beam, field.forces, hertz, periods / hertz, model="analytic", slider=slider, samples=samples)
    return simulate(
        beam,
        field.forces,
        hertz,
        periods / hertz,
        model="analytic",
        start="steady",
        slider=slider,
        samples=samples,
        ledger=False,
    )
