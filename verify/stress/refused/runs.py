"""What is found only once something is solved: drives on a resonance, waves that stand, sizes that do not reach."""

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.chain import departure, dynamics, problems, ride, statics
from verify.chain.small_motion import _turning_squares, choose_pivots, refuse_unstable_modes
from verify.chain.system import ChainState, LinkLoad, build_system
from verify.device import Device
from verify.exact.closed_forms import frequency_hz
from verify.exact.spans import _check_spans
from verify.judge.compare import paired_index
from verify.judge.sizing import _gallop_up, _scanned
from verify.judge.workbench import Workbench
from verify.models.arrays import Array
from verify.models.catalogue import MODELS, check_count
from verify.models.fields import HarmonicField
from verify.models.naming import Among
from verify.motion.free_vibration import free_vibration
from verify.motion.simulate import simulate
from verify.options import Support
from verify.patience import PATIENCE_S
from verify.stress.kind import Row
from verify.stress.references.beams import STEPPED, STRIP, held
from verify.stress.refusals import Ask, Case, refusals
from verify.stress.waves.closed_forms import held_resonance
from verify.waves.absorber import beam_impedance
from verify.waves.case import DrivenCase
from verify.waves.driven import best_frequency, driven, operation, power_imbalance, quietest
from verify.waves.found import TwoWaves
from verify.waves.measures import fitted_wavenumber, measure
from verify.waves.operating_point import fastest_point, operating_points
from verify.waves.unit_waves import Gaps, UnitDrive, receptance

FORCES = (PointForce(position=0.05), PointForce(position=0.69, phase_deg=80.0))
CLAMPED, FREE = held("clamped", "free"), held("free", "free")
LOSSY = replace(STRIP, loss_factor=0.01)
SPRING = Device(position=0.2, stiffness=3000.0)
HERTZ = 9100.0


def case(**more: object) -> DrivenCase:
    """The lossy strip under two forces."""
    given: dict[str, object] = {
        "beam": LOSSY,
        "model": "analytic",
        "count": None,
        "forces": FORCES,
        "frequency_hz": HERTZ,
    }
    return DrivenCase(**(given | more))  # type: ignore[arg-type]


def field(**more: object) -> Callable[[], HarmonicField]:
    """Its field."""
    return lambda: driven(case(**more), Workbench(case(**more).beam))


@cache
def mode(number: int, beam: Beam = STRIP) -> float:
    """A frequency of the strip, Hz."""
    return frequency_hz(beam, number)


def imposed(hertz: float, *places: float) -> Ask:
    """A millimetre at places of the strip."""
    forces = tuple(PointForce(position=at, amplitude=1e-3) for at in places)
    return field(beam=STRIP, forces=forces, frequency_hz=hertz, kind="displacement")


def late(made: Callable[[], Ask]) -> Ask:
    """What takes a solve to be asked, made when it is."""

    def ask() -> object:
        return made()()

    return ask


def swept(model: str, count: int | None, *hertz: float, **settings: object) -> Ask:
    """Many frequencies at once."""
    return lambda: MODELS[model].sweep_harmonic(STRIP, FORCES[:1], np.array(hertz), count, **settings)


def many(model: str, *beams: Beam) -> Ask:
    """The first frequency of many beams in one call."""
    from verify.elements import sweeps as of_elements
    from verify.exact import sweeps as exact
    from verify.segments import sweeps as of_segments

    if model == "analytic":
        return lambda: exact.sweep_modes(beams, 1)
    return lambda: {"fem": of_elements, "segment": of_segments}[model].sweep_modes(beams, 1, 9)


def waves(hertz: Array, kind: str = "force") -> Ask:
    """Unit waves of the undamped strip at frequencies, none of which has a figure."""
    drive = UnitDrive(beam=STRIP, model="analytic", count=None, kind=kind, places=(0.3, 0.69), window=(0.35, 0.6))

    def ask() -> object:
        gaps = Gaps()
        drive.waves(hertz, gaps)
        return gaps.reasons(len(hertz))

    return ask


def counted(model: str, count: int | None) -> Ask:
    """A model's parts."""
    return lambda: check_count(model, count)


def named(model: str, **more: bool) -> Ask:
    """A model that has modes."""
    return lambda: Among("solve_modes", **more).check(model)


def law(supports: tuple[Support, Support], **settings: Any) -> Ask:
    """The leading law of nine segments."""
    from verify.quantities.kind import DiscreteAtSize
    from verify.quantities.modes import _check_law

    return lambda: _check_law(DiscreteAtSize(model="segment", mode=1, count=9, **settings), held(*supports))


def sized(model: str, **settings: Any) -> Ask:
    """A mode of a model of nine parts."""
    from verify.quantities.kind import AtSize

    return lambda: AtSize(model=model, mode=1, count=9, **settings)


def planned(*settings: tuple[str, str]) -> Ask:
    """The exact strip on its second mode, before it is solved."""
    from verify.quantities.beforehand import _check_closed_form

    return lambda: _check_closed_form(case(beam=STRIP, frequency_hz=mode(2), settings=settings))


def ordered(of: str) -> Ask:
    """An order of convergence in a window that holds a force."""
    from verify.quantities.beforehand import _check_window
    from verify.quantities.wave_arguments import WaveOrder

    given: Any = {"model": "fem", "counts": (40, 80, 160), "of": of, "window": (0.01, 0.6)}
    return lambda: _check_window(WaveOrder(**given), case())


def placed(x: float) -> Ask:
    """A figure at a place of a metre."""
    from verify.quantities.catalogue import _check_places
    from verify.quantities.wave_arguments import AxisRatio

    return lambda: _check_places(AxisRatio(x=x), 1.0)


def two(backward: complex) -> TwoWaves:
    """A wave of 1 m and one against it."""
    return TwoWaves(wavenumber=30.0 + 0j, forward=1.0 + 0j, backward=backward, residual=0.0)


def moved(model: str, count: int | None, hertz: float, **more: object) -> Ask:
    """The strip in time."""
    asked: dict[str, Any] = {"model": model, "count": count, "modes": None if count else 5, **more}
    return lambda: simulate(STRIP, FORCES[:1], hertz, 0.01, **asked)


def segment_hertz(number: int) -> float:
    """A frequency of nine segments."""
    return float(MODELS["segment"].solve_modes(STRIP, number, 9).frequencies_hz[number - 1])


def leaning(amount: float, *dependent: int) -> Ask:
    """A hinged chain, its middle held off the line by a state that cannot be brought back by the last joint."""
    system = build_system(STRIP, 5)
    state = ChainState(np.array([amount, 0.0, 0.0, 0.0, 0.0]), np.zeros(5))
    return lambda: dynamics.project(system, state, dependent or [5])


def kept(*times: float) -> Ask:
    """A slider on a chain whose states stand at these times."""
    return lambda: ride._check_times(np.array(times))


def off_by(linear: float) -> Ask:
    """How far three deflections of 1 m depart from linear ones."""
    return lambda: departure.departure_of(np.ones(3), np.full(3, linear))


def raised(height: float) -> Ask:
    """The middle of a chain."""
    return lambda: problems._check_height(height, build_system(STRIP, 4))


def pushed(newton: float) -> Ask:
    """A pin-ended mechanism without springs, pushed across."""
    from dataclasses import replace as changed

    system = build_system(held("pinned", "free"), 4)
    load = LinkLoad(link=4, at=0.05, force=(0.0, newton))
    return lambda: statics.solve_static(changed(system, stiffness=np.zeros(4), loads=(load,) if newton else ()))


def gone_through(failed: int, share: float) -> Ask:
    """Sizes up to one that fails, where solves of those after it take this share of what is waited for."""
    ahead = failed + (1.5 * failed**2 if failed < 100 else 20.0 * failed)
    each_s = share * PATIENCE_S / ahead
    return lambda: _scanned(lambda n: n > failed, failed, failed, "segment", 1e-3, each_s=each_s)


def turning(spin: float, follows: float) -> Ask:
    """Two motions on springs that push outwards, which spin couples, or that are coupled by a load that follows."""
    spring = np.array([[-1.0, follows], [-follows, -1.0]]) if spin else np.array([[1.0, follows], [-follows, 1.0]])
    return lambda: _turning_squares(np.eye(2), np.array([[0.0, spin], [-spin, 0.0]]), spring)


ROWS: tuple[Row, ...] = (
    refusals(
        "refused-once-solved",
        "Drives on a resonance, waves that stand, settings beside each other that do not go, searches that end",
        "waves, motion, models: what only a solve shows is refused by the field that can change it.",
        Case("frequency_hz = ", late(lambda: imposed(held_resonance(), 0.3)), imposed(41.7, 0.3)),
        Case("drive.force positions [0.3, 0.3]", imposed(41.7, 0.3, 0.3), imposed(41.7, 0.3, 0.31)),
        Case("drive.force positions [0.0]", imposed(41.7, 0.0)),
        Case("drive.kind = 'displacement'", field(kind="displacement", devices=(SPRING,)), field(devices=(SPRING,))),
        Case(
            "drive.device at 0.2 m",
            lambda: fastest_point(case(devices=(SPRING,)), 0.2),
            lambda: fastest_point(case(), 0.9),
        ),
        Case(
            "the reflection has a phase between two forces, the scene has 1",
            lambda: operating_points(case(forces=FORCES[:1])),
            lambda: operating_points(case()),
        ),
        Case("limit = 1e-09", lambda: fastest_point(case(), 1e-9), lambda: fastest_point(case(), 0.9)),
        Case(
            "span = 1e-06: the reflection still falls",
            lambda: best_frequency(case(), 1e-6, None, Workbench(LOSSY)),
            lambda: best_frequency(case(), 0.015, None, Workbench(LOSSY)),
        ),
        Case("phase_deg: with this phase", lambda: quietest(lambda f: 0.0 * f + 1.0, np.array([1.0, 2.0, 3.0]))),
        Case("the wave stands", lambda: two(1.0 + 0j).check_travelling(), lambda: two(0.999 + 0j).check_travelling()),
        Case(
            "the wave stands",
            lambda: (
                measure(driven(case(beam=STRIP, forces=FORCES[:1]), Workbench(STRIP)), (0.1, 0.6)).signed_area_spread
            ),
            lambda: measure(driven(case(), Workbench(LOSSY)), (0.1, 0.6)).signed_area_spread,
        ),
        Case(
            "the field is zero in the window",
            lambda: operation(driven(case(forces=(PointForce(position=0.0),)), Workbench(LOSSY))),
            lambda: operation(driven(case(), Workbench(LOSSY))),
        ),
        Case(
            "the fitted wavenumber ends at the edge",
            lambda: fitted_wavenumber(np.linspace(0.0, 0.5, 99), np.exp(-33j * np.linspace(0.0, 0.5, 99)), 30.0 + 0j),
            lambda: fitted_wavenumber(np.linspace(0.0, 0.5, 99), np.exp(-30.6j * np.linspace(0.0, 0.5, 99)), 30.0 + 0j),
        ),
        Case(
            "beam.section",
            lambda: power_imbalance(
                driven(case(beam=replace(STEPPED, loss_factor=0.01)), Workbench(STEPPED)),
                measure(driven(case(), Workbench(LOSSY)), (0.1, 0.6)),
            ),
            lambda: power_imbalance(
                driven(case(), Workbench(LOSSY)), measure(driven(case(), Workbench(LOSSY)), (0.1, 0.6))
            ),
        ),
        Case("frequency_hz = ", lambda: receptance("segment", STRIP, 0.3, segment_hertz(3), 0.2, 9)),
        Case("frequency_hz = ", waves(np.array([mode(22)])), waves(np.array([mode(22), 1.01 * mode(22)]))),
        *(
            Case(
                "frequencies_hz[1] = ",
                lambda model=model, count=count, own=own: swept(model, count, 37.0, own())(),  # type: ignore[misc]
                swept(model, count, 37.0, 38.0),
            )
            for model, count, own in (("analytic", None, lambda: mode(2)), ("segment", 9, lambda: segment_hertz(2)))
        ),
        *(Case("beams is empty", many(model)) for model in ("analytic", "segment", "fem")),
        Case(
            "beams[1]: beam.tension",
            many("fem", STRIP, replace(STRIP, tension=-1e6)),
            many("fem", STRIP, replace(STRIP, tension=-1.0)),
        ),
        Case("frequency_hz = ", late(lambda: moved("segment", 9, segment_hertz(2))), moved("segment", 9, 37.0)),
        Case("frequency_hz = ", moved("analytic", None, mode(2)), moved("analytic", None, mode(2), modal_damping=0.01)),
        Case(
            "shape: ",
            lambda: free_vibration(STRIP, lambda x: x * (STRIP.length - x), 0.01, model="analytic", modes=5000),
            lambda: free_vibration(STRIP, lambda x: x * (STRIP.length - x), 0.01, model="analytic", modes=5),
        ),
        Case("position = ", lambda: beam_impedance(STRIP, HERTZ, 0.0, "clamped", turning=True)),
        Case("frequency_hz = ", planned(), planned(("theory", "rayleigh"))),
        Case("window = [0.01, 0.6]", ordered("axis_ratio"), ordered("deflection")),
        Case("x = 1.000000000002", placed(1.0 + 2e-12), placed(1.0 + 5e-13)),
        Case("x = -2e-12", placed(-2e-12), placed(-5e-13)),
        Case("wall = 'half'", law(("clamped", "free"), wall="half"), law(("pinned", "pinned"), wall="half")),
        Case("theory = 'rayleigh'", law(("pinned", "pinned"), theory="rayleigh")),
        Case("grading = 2.0", law(("pinned", "pinned"), grading=2.0), law(("clamped", "free"), joints="printed")),
        Case("wall = 'half' is a setting of model = segment", sized("fem", wall="half"), sized("segment", wall="half")),
        Case("joints = 'printed' is a setting of", sized("fem", joints="printed"), sized("mean", wall="half")),
    ),
    refusals(
        "refused-sizes-and-chains",
        "Names and sizes that no model has, sizes that do not reach, chains that cannot stand or be held",
        "models/catalogue.py, judge/sizing.py, chain: what is wrong with a number is said with the number.",
        Case("count is missing", counted("segment", None), counted("segment", 9)),
        Case(
            "count = 5 is for models of parts",
            lambda: check_count("analytic", 5),
            lambda: check_count("analytic", None),
        ),
        Case(
            "model = 'fems' is not known",
            named("fems"),
            named("fem"),
        ),
        Case("model = 'analytic' is not known", named("analytic", sized=True), named("analytic")),
        Case(
            "model = 'mean' is not known",
            lambda: Among("solve_modes").check("mean"),
            lambda: Among("solve_modes", mean=True).check("mean"),
        ),
        Case("frequency: this beam bends in so many waves", lambda: _check_spans(100_001)),
        Case(
            "mode = 3: no fem mode",
            lambda: paired_index(MODELS["fem"].solve_modes(STRIP, 3, 9), np.ones((3, 37)), 3, 1),
        ),
        Case(
            "error = 0.01: the segment model does not reach it",
            lambda: _gallop_up(lambda n: False, 9, "segment", 0.01),
            lambda: _gallop_up(lambda n: n > 99_999, 9, "segment", 0.01),
        ),
        Case(
            "error = 0.001: the segment model, whose error goes up and down",
            lambda: _scanned(lambda n: n % 7 != 0 or n > 2050, 2, 30, "segment", 1e-3, uneven=True),
            lambda: _scanned(lambda n: n % 7 != 0 or n > 50, 2, 30, "segment", 1e-3, uneven=True),
        ),
        Case("count = 'beyond 40'", gone_through(40, 1.001), gone_through(40, 0.999)),
        Case("count = 'beyond 150'", gone_through(150, 1.001), gone_through(150, 0.999)),
        Case("the equilibrium is unstable: it flutters", turning(0.0, 1.0), turning(3.0, 0.0)),
        Case("the equilibrium is unstable: mode 1 grows", lambda: refuse_unstable_modes(np.array([-4.0, 1.0]))),
        Case(
            "the equilibrium is unstable: modes 1 to 2 grow (omega^2 = -4 1/s^2, e-fold in 0.5 s",
            lambda: refuse_unstable_modes(np.array([-4.0, -1.0, 1.0])),
            lambda: refuse_unstable_modes(np.array([0.0, 1.0])),
        ),
        Case(
            "chain: its held points cannot be held",
            lambda: choose_pivots(np.array([[1.0, 2.0, 3.0], [2.0, 4.0, 6.0]])),
            lambda: choose_pivots(np.array([[1.0, 2.0, 3.0], [2.0, 4.0, 6.1]])),
        ),
        Case(
            "dependent = [9]",
            lambda: dynamics.project(build_system(STRIP, 5), ChainState(np.zeros(5), np.zeros(5)), [9]),
        ),
        Case(
            "dependent = [1, 2]",
            lambda: dynamics.project(build_system(STRIP, 5), ChainState(np.zeros(5), np.zeros(5)), [1, 2]),
        ),
        Case("state.angles cannot be brought", leaning(1.2), leaning(0.05)),
        Case("chain.loads: no equilibrium found", pushed(1.0)),
        Case(
            "times: 4 states",
            lambda: ride._check_times(np.linspace(0.0, 3e-5, 4)),
            lambda: ride._check_times(np.linspace(0.0, 3e-5, 5)),
        ),
        Case("times: 5 states", kept(0.0, 1.0, 2.0, 3.0, 4.5)),
        Case(
            "force: under it the linear chain",
            lambda: departure.departure_of(np.ones(3), np.zeros(3)),
            lambda: departure.departure_of(np.ones(3), np.ones(3)),
        ),
        Case(
            "amplitude: the middle would stand",
            lambda: problems._check_height(0.11, build_system(STRIP, 4)),
            lambda: problems._check_height(0.07, build_system(STRIP, 4)),
        ),
        Case("amplitude: the middle would stand 0 m off", raised(0.0), raised(1e-9)),
    ),
)
