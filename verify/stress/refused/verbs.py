"""What every verb refuses by itself, whoever else looks too: beams, words, sizes, numbers and works of each."""

from collections.abc import Callable, Iterator
from dataclasses import replace as changed
from functools import partial
from math import nan
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.beam import PointForce
from verify.chain import confirmed, dynamics, problems, ride, splitting, warm
from verify.chain.result import ChainMotion
from verify.chain.system import Actuator, ChainState, LinkLoad, build_system
from verify.contact import belt, bouncing, foot, landing, layer
from verify.exact import closed_forms, error_laws
from verify.exact import modes as exact
from verify.judge.variants import Rules
from verify.judge.workbench import comparable
from verify.models.catalogue import MODELS
from verify.motion import pure_wave, rigid_surface
from verify.slider import Slider
from verify.stress.chain.coils import _done
from verify.stress.kind import Row
from verify.stress.references.beams import STEPPED, STRIP, held
from verify.stress.refusals import Ask, Case, refusals
from verify.waves import absorber
from verify.waves.lumped import TwoModes, local_waves
from verify.waves.series import check_series
from verify.waves.unit_waves import UnitDrive, unit_fields

FORCES, OFF = (PointForce(position=0.2),), (PointForce(position=0.7301),)
FREE = held("free", "free")
BUCKLED = replace(STRIP, tension=-1e6)
ONE, PLACES = np.array([37.0]), np.array([0.3])
MANY = np.broadcast_to(37.0, 3_300_000)
SIZES: tuple[tuple[str, int | None], ...] = (("segment", 9), ("fem", 9), ("analytic", None))
PARTS = SIZES[:2]
SLIDER = Slider(mass=0.01, mu=0.3)


def verbs(model: str, count: int | None) -> dict[str, Callable[..., object]]:
    """(beam, settings) -> what a model is asked."""
    own: Any = MODELS[model]
    return {
        "modes": lambda beam, **more: own.solve_modes(beam, 2, count, **more),
        "field": lambda beam, **more: own.solve_harmonic(beam, FORCES, 37.0, count, **more),
        "sweep": lambda beam, **more: own.sweep_harmonic(beam, FORCES, ONE, count, **more),
        "units": lambda beam, **more: own.unit_responses(beam, (0.2,), ONE, PLACES, count, **more),
        "check": lambda beam, **more: own.check(beam, 2, count, **more),
    }


def of_all_verbs() -> Iterator[Case]:
    """A beam that has buckled and a theory that is none, asked of every verb of every model."""
    for model, count in SIZES:
        for ask in verbs(model, count).values():
            yield Case("beam.tension = -1000000.0 N", partial(ask, BUCKLED), partial(ask, STRIP))
            yield Case("theory = 'bernoulli' is", partial(ask, STRIP, theory="bernoulli"))


def swept(model: str, count: int | None, hertz: Any = ONE, forces: tuple[PointForce, ...] = FORCES, **more: Any) -> Ask:
    """A strip at many frequencies."""
    return lambda: MODELS[model].sweep_harmonic(STRIP, forces, hertz, count, **more)


def driven(model: str, count: int | None, **more: Any) -> Ask:
    """A strip at one."""
    return lambda: MODELS[model].solve_harmonic(STRIP, FORCES, 37.0, count, **more)


def based(model: str, count: int | None, modes: int = 3, *supports: str) -> Ask:
    """What moves in time."""
    return lambda: MODELS[model].time_basis(held(*(supports or ("pinned", "pinned"))), count, modes, "spline")


def many(room: str, n_modes: int, *beams: Any) -> Ask:
    """The first modes of beams in one call, by nine parts."""
    from importlib import import_module

    size = () if room == "exact" else (9,)
    return lambda: import_module(f"verify.{room}.sweeps").sweep_modes(beams or (STRIP,), n_modes, *size)


def dashed() -> object:
    """Dashpots beside a ratio, in a sweep."""
    beam = held("clamped", "free")
    return MODELS["segment"].sweep_harmonic(beam, FORCES, ONE, 9, joint_dashpot=0.01, modal_damping=0.01)


def of_models() -> Iterator[Case]:
    """Forces off the beam, more figures than are kept, dense modes of too many unknowns, sizes, settings."""
    for model, count in SIZES:
        yield Case("force.position = 0.7301", swept(model, count, forces=OFF), swept(model, count))
        yield Case("frequencies_hz: 3300000", swept(model, count, MANY))
    for model, count in PARTS:
        unknowns = {"segment": 1199, "fem": 2400}[model]
        for ask in (swept, driven):
            yield Case(
                f"modal_damping takes all {unknowns}",
                ask(model, 1200, modal_damping=0.01),
                ask(model, 20, modal_damping=0.01),
            )
        yield Case("modal_damping = -0.01", swept(model, count, modal_damping=-0.01))
        yield Case("motion in time takes all", based(model, 1200, 3, "clamped", "free"), based(model, count))
        yield Case("grading = 0.0", partial(MODELS[model].solve_modes, STRIP, 2, 9, grading=0.0))
        yield Case("grading = -1.0", partial(MODELS[model].buckling_load, STRIP, 9, grading=-1.0))
        yield Case("count = 9: 9", partial(MODELS[model].check_carried, STRIP, 9, 1e5))
        yield Case("n_modes = 200000", partial(MODELS[model].check, STRIP, 200_000, 9))
    yield Case("count = 0", based("segment", 0), based("segment", 2))
    yield Case("count = 0", based("fem", 0), based("fem", 2))
    yield Case("modes = 0", based("analytic", None, 0), based("analytic", None, 1))
    buckled: Callable[..., float] = MODELS["segment"].buckling_load
    for given in (0, 1, "20"):
        yield Case(f"count = {given!r}: ", partial(buckled, STRIP, given))
    for setting in ("wall", "joints", "attachment"):
        yield Case(f"{setting} = 'rw' is not", partial(buckled, STRIP, 9, **{setting: "rw"}))
    yield Case("count = 0", partial(MODELS["fem"].buckling_load, STRIP, 0))
    yield Case("load = 'levr'", swept("segment", 9, load="levr"), swept("segment", 9, load="lever"))
    yield Case("reading = 'rw'", swept("segment", 9, reading="rw"), swept("segment", 9, reading="raw"))
    yield Case("joint_dashpot and modal_damping together", dashed)
    for room, parts in (("segments", "8 elastic modes"), ("elements", "18 elastic modes"), ("exact", "")):
        yield Case("n_modes = 0", many(room, 0), many(room, 1))
        yield Case("beams[1]: beam.tension", many(room, 1, STRIP, BUCKLED))
        if parts:
            yield Case(f"beams[0]: n_modes = 40 is more than the {parts}", many(room, 40))


def stepped(hertz: float) -> object:
    """The exact field of a stepped beam."""
    return MODELS["analytic"].solve_harmonic(STEPPED, FORCES, hertz, None)


def of_exact() -> Iterator[Case]:
    """Modes, theories, buckled and stepped beams, and what no floating point holds."""
    x = np.array([0.1])
    yield Case("beam.section", lambda: closed_forms.quarter_wavelength(STEPPED, 37.0))
    yield Case("mode = 0", lambda: error_laws.dispersion_frequency_hz("segment", STRIP, 0, 9))
    yield Case("beam.section", lambda: error_laws.dispersion_frequency_hz("segment", STEPPED, 1, 9))
    yield Case("beam.section", lambda: error_laws.discrete_wavenumber("segment", STEPPED, 9, 37.0))
    yield Case("count = 9: 9 segments", lambda: error_laws.discrete_wavenumber("segment", STRIP, 9, 1e5))
    for beam in (STRIP, STEPPED):
        yield Case("mode = 0", partial(exact.exact_frequency_hz, beam, 0), partial(exact.exact_frequency_hz, beam, 1))
        yield Case("mode = 0", partial(exact.mode_shape, beam, 0, x))
    yield Case("beam.tension", partial(exact.exact_frequency_hz, BUCKLED, 1))
    yield Case("beam.tension", partial(exact.mode_shape, BUCKLED, 1, x))
    yield Case("theory = 'bernoulli'", partial(exact.mode_shape, STRIP, 1, x, 0, "bernoulli"))
    yield Case("frequency_hz = ", lambda: stepped(exact.exact_frequency_hz(STEPPED, 2)), lambda: stepped(47.0))
    yield Case("frequency_hz: at |k| L", partial(MODELS["analytic"].solve_harmonic, FREE, FORCES, 1e-200, None))


def rubbed(kinetic: float, static: float, speed: float = 0.1) -> Ask:
    """A mass on a belt."""
    return lambda: belt.stick_slip_times(0.01, 100.0, static, kinetic, speed)


def of_contacts() -> Iterator[Case]:
    """Numbers that are none."""
    yield Case("kinetic = -1.0", rubbed(-1.0, 2.0), rubbed(1.0, 2.0))
    yield Case("static = -1.0", rubbed(0.0, -1.0))
    yield Case("acceleration_ratio = nan", lambda: bouncing.leaving_phase(nan))
    yield Case("acceleration_ratio = 0.0", lambda: bouncing.bounce_in_step(0.0, 0.3))
    yield Case("speed_ratio = nan", lambda: foot.short_foot_force(0.3, nan), lambda: foot.short_foot_force(0.3, 0.1))
    yield Case("stiffness = 0.0", lambda: landing.damping_ratio(1.0, 0.0, 1.0))
    yield Case("damping_ratio = -1.0", lambda: landing.lift_off_ratio(1.0, -1.0))
    yield Case("speed_ratio = nan", lambda: layer.force(0.3, nan), lambda: layer.force(0.3, 0.1))
    yield Case("speed_ratio = nan", lambda: layer.half_space_force(0.3, nan))
    yield Case("contact_half_angle = nan", lambda: layer.no_load_speed(nan))
    yield Case("contact_half_angle = nan", lambda: layer.efficiency(nan, 0.1))
    stuck = partial(rigid_surface.stick_slip_times, 0.01, 100.0)
    yield Case("kinetic = 2.0 is not below", partial(stuck, 1.0, 2.0, 0.1))
    settled = partial(pure_wave.terminal_speed, STRIP)
    yield Case("amplitude = 0.0", partial(settled, SLIDER, 0.0, 9100.0))
    yield Case("slider.contact", partial(settled, replace(SLIDER, contact=_hard()), 1e-6, 9100.0))


def _hard() -> Any:
    from verify.slider import Contact

    return Contact()


def of_waves() -> Iterator[Case]:
    """Two modes, series, windows, models without derivatives."""
    yield Case("ratio = 0.0", lambda: TwoModes(beam=STRIP, modes=(1, 2), ratio=0.0, phase_deg=0.0))
    yield Case("phase_deg = nan", lambda: TwoModes(beam=STRIP, modes=(1, 2), ratio=1.0, phase_deg=nan))
    yield Case("frequency_hz = 0.0", lambda: check_series(np.arange(9.0), np.zeros((9, 3)), 0.0))
    yield Case("model = 'fem'", lambda: local_waves(MODELS["fem"].solve_harmonic(STRIP, FORCES, 37.0, 9), [0.1]))
    yield Case("model = 'none' is not known", lambda: unit_fields("none", STRIP, (0.2,), ONE, PLACES, 9))
    impedance = partial(absorber.beam_impedance, STRIP, 370.0)
    yield Case("position = 0.0 m", partial(impedance, 0.0, "pinned"), partial(impedance, 0.1, "pinned"))
    yield Case("window = [0.15, 0.6]", _seen(0.2), _seen(0.01))
    yield Case("model = 'fems'", lambda: Rules(grading=2.0).variants(("fems",)))
    yield Case("wall = 'half' is", lambda: Rules(wall="half").variants(("fem",)), lambda: Rules().variants(("fem",)))
    yield Case("count = 0", lambda: comparable(STRIP, (0,), 1), lambda: comparable(STRIP, (9,), 1))


def _seen(first: float) -> Ask:
    drive = UnitDrive(beam=STRIP, model="analytic", count=None, kind="force", places=(first, 0.69), window=(0.15, 0.6))
    from verify.waves.unit_waves import Gaps

    return lambda: drive.waves(np.array([9100.0]), Gaps())


# --- Chains -----------------------------------------------------------------------------------------------------------

CHAIN = build_system(held("clamped", "free"), 4)
LONG = 20_001


def loaded(**more: Any) -> Ask:
    """A load with one number that is none."""
    return lambda: LinkLoad(link=1, at=0.0, **more)


def acted(**more: Any) -> Ask:
    """An actuator likewise."""
    return lambda: Actuator(link=1, at=0.0, **more)


def moved(**more: Any) -> ChainMotion:
    """A chain at two times."""
    none, rows = np.zeros(2), np.zeros((2, 4))
    given: dict[str, Any] = {"angles": rows, "rates": rows, "dissipated": none, "work_in": none}
    return ChainMotion(**({"system": CHAIN, "times": np.arange(2.0), "statistics": _done()} | given | more))


def diverged() -> ChainMotion:
    """The same, stopped early."""
    return moved(statistics=changed_end("diverged at t = 1 s"))


def changed_end(stopped: str) -> Any:
    """Statistics of a run that was stopped."""
    return replace(_done(), stopped=stopped)


def ridden(slider: Slider = SLIDER, count: int = 6, duration: float = 1e-4, step: float = 1e-5, **more: Any) -> Ask:
    """A slider on a chain from rest."""
    one = replace(slider, coupling="one-way")
    beam = more.pop("beam", STRIP)
    return lambda: ride.ride_from_rest(beam, FORCES, 37.0, one, count, duration, step=step, most=0.0, **more)


def of_chains() -> Iterator[Case]:
    """Numbers of loads and actuators, places, sizes, works, motions that broke off."""
    yield Case("load.force x = nan", loaded(force=(nan, 0.0)), loaded(force=(1.0, 0.0)))
    yield Case("load.force y = nan", loaded(force=(0.0, nan)))
    yield Case("load.moment = nan", loaded(moment=nan))
    yield Case("load.phase_deg = nan", loaded(phase_deg=nan))
    yield Case("actuator.amplitude = nan", acted(amplitude=nan), acted(amplitude=1.0))
    yield Case("actuator.phase_deg = nan", acted(phase_deg=nan))
    yield Case("load.at = nan", lambda: changed(CHAIN, loads=(LinkLoad(link=1, at=nan),)))
    yield Case("chain.lengths is empty", without_links)
    yield Case("x = 0.7301", lambda: moved().points([0.7301]), lambda: moved().points([0.73]))
    yield Case("x = -1e-09", lambda: moved().points([-1e-9]), lambda: moved().points([0.0]))
    check = confirmed.check_moved
    yield Case("the chain's motion diverged", lambda: check(diverged()), lambda: check(moved()))
    yield Case("the chain's motion diverged", lambda: problems._finished(diverged()))
    tall = partial(problems.first_shape, CHAIN)
    yield Case("amplitude: a link would rise", partial(tall, 0.26), partial(tall, 0.25))
    yield Case(
        f"segments = {LONG}", lambda: problems.cantilever_tip(1.0, LONG), lambda: problems.cantilever_tip(1.0, 3)
    )
    yield Case(f"segments = {LONG}", lambda: problems.rollup_gap(LONG), lambda: problems.rollup_gap(3))
    turning = partial(problems.turning_frequency, 1)
    yield Case(f"segments = {LONG}", lambda: problems.hanging_frequency(1, LONG))
    yield Case(f"segments = {LONG}", lambda: turning(LONG, 0.1), lambda: turning(3, 0.1))
    yield Case("segments = 1", lambda: problems.energy_drift(STRIP, 1, 0.01, 0.0, None, 1e-9))
    yield Case("segments = 2", lambda: problems.shaken_imbalance(2, "free", 1e-9))
    passing = partial(problems.transient, STRIP, FORCES, 37.0, [0.0, 1.0], method="linear")
    yield Case(f"segments = {LONG}", lambda: passing(LONG), lambda: passing(3))
    yield Case("segments = 1", lambda: problems.contact_line_error(STRIP, 1, 1, 0.2))
    yield Case("time = 1 s in steps of 1e-05 s", ridden(duration=1.0))
    yield Case("segments = 1", ridden(count=1))
    yield Case("slider.line = 'raw'", ridden(replace(SLIDER, line="raw")))
    yield Case("time = 0.001 s takes about", kicked)
    yield Case("chain.dashpots up to 0.001", seen(1e-3), seen(0.0))


def without_links() -> object:
    """A chain of none."""
    none = np.zeros(0)
    return changed(CHAIN, lengths=none, masses=none, inertias=none, stiffness=none, dashpots=none)


def kicked() -> object:
    """More work than is allowed."""
    basis = splitting.modal_basis(CHAIN)
    return splitting.simulate_modal(basis, dynamics.at_rest(CHAIN), [0.0, 1e-3], step=1e-5, most=10.0)


def seen(dashpot: float) -> Ask:
    """One point of a linear chain at times."""
    system = changed(CHAIN, dashpots=np.full(4, dashpot))
    start = ChainState(np.zeros(4), np.zeros(4))
    return lambda: splitting.linear_deflection(splitting.modal_basis(system), start, np.arange(3.0), 0.2)


ROWS: tuple[Row, ...] = (
    refusals(
        "refused-by-every-verb",
        "Beams that have buckled and words that are none, asked of every verb of every model, one by one and in sweeps",
        "segments, elements, exact: whoever is asked looks himself.",
        *of_all_verbs(),
        *of_models(),
    ),
    refusals(
        "refused-numbers",
        "Modes, contacts, waves and settings by numbers and words that are none",
        "exact, contact, waves, judge: each says which of its numbers.",
        *of_exact(),
        *of_contacts(),
        *of_waves(),
    ),
    refusals(
        "refused-chain-numbers",
        "Loads, places, sizes and works of nonlinear chains, and motions that broke off",
        "chain: each says which of its numbers.",
        *of_chains(),
        kernels=warm.rigid,
    ),
)
