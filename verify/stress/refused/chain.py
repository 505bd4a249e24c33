"""What the nonlinear chain refuses: chains that are none, and motions of it that are not begun."""

from collections.abc import Iterator, Sequence
from dataclasses import replace as changed
from math import nan

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.chain import bending, departure, dynamics, problems, ride, splitting, stepping, stretching, warm
from verify.chain.system import Actuator, ChainState, ChainSystem, LinkLoad, Rotation, build_system
from verify.chain.work import check_kept, refuse_work
from verify.models.compiling import Call
from verify.slider import Slider
from verify.stress.kind import Row
from verify.stress.references.beams import PLAIN, STEPPED, STRIP, held
from verify.stress.refusals import Ask, Case, refusals

CANTILEVER = held("clamped", "free")
FORCES = (PointForce(position=0.2),)
HERTZ, LINKS = 37.0, 6
LINK = STRIP.length / LINKS
SLIDER = Slider(mass=0.01, mu=0.3)
STILL, MOVING = np.zeros(LINKS), np.ones(LINKS)
ACTUATOR = Actuator(link=2, at=0.01)
TIMES = (1e-5, 2e-5)


def built(on: Beam = CANTILEVER, forces: Sequence[PointForce] = (), **more: object) -> Ask:
    """A chain of six links."""
    return lambda: build_system(on, LINKS, forces, HERTZ, **more)  # type: ignore[arg-type]


def chain(**changes: object) -> ChainSystem:
    """The cantilever's, with other figures."""
    return changed(build_system(CANTILEVER, LINKS), **changes)  # type: ignore[arg-type]


def with_(**changes: object) -> Ask:
    """The same, asked for."""
    return lambda: chain(**changes)


def scaled(field: str, factor: float) -> Ask:
    """The cantilever's chain with one of its rows scaled."""
    return lambda: chain(**{field: factor * getattr(chain(), field)})


def loaded(link: int, at: float) -> Ask:
    """With a load at a place on a link."""
    return with_(loads=(LinkLoad(link=link, at=at),))


def stepped(times: Sequence[float] = TIMES, **more: object) -> Ask:
    """Moved in steps."""
    return lambda: stepping.simulate(chain(), dynamics.at_rest(chain()), times, **more)  # type: ignore[arg-type]


def damped() -> splitting.ModalBasis:
    """Modes of a chain with dashpots."""
    return splitting.modal_basis(build_system(CANTILEVER, LINKS, joint_dashpot=1e-3))


def split(times: Sequence[float] = TIMES, dashpots: bool = False, step: float = 1e-5, **more: int) -> Ask:
    """Moved by linear flow and kicks."""

    def ask() -> object:
        basis = damped() if dashpots else splitting.modal_basis(chain())
        return splitting.simulate_modal(basis, dynamics.at_rest(chain()), times, step=step, **more)

    return ask


def pulled(newton: float) -> Ask:
    """With links that stretch, driven so hard for 0.3 s that they may turn right over."""

    def ask() -> object:
        driven = departure.Driven(
            beam=CANTILEVER, forces=FORCES, frequency_hz=HERTZ, count=LINKS, x=0.365, times=np.linspace(0.0, 0.3, 101)
        )
        return departure.elastic_chain(driven, newton)

    return ask


def linear(*times: float) -> Ask:
    """One point by linear flow alone."""
    basis = splitting.modal_basis
    return lambda: splitting.linear_deflection(basis(chain()), dynamics.at_rest(chain()), np.array(times), 0.2)


def stretched(
    times: Sequence[float] = (0.0, 1e-6), of: ChainSystem | None = None, newton: object = 8e6, **more: float
) -> Ask:
    """Links that stretch."""
    return lambda: stretching.simulate_elastic(of or chain(), newton, times, **more)  # type: ignore[arg-type]


def straight(rates: np.ndarray[tuple[int], np.dtype[np.float64]] = STILL, links: int = LINKS, **changes: object) -> Ask:
    """Linearised about straight."""
    return lambda: dynamics.linearise(chain(**changes), ChainState(np.zeros(links), rates))


def ridden(of: ChainSystem | None = None, on: Beam = CANTILEVER, **slider: str) -> Ask:
    """A slider on it."""
    return lambda: ride.check_rideable(of or chain(), on, replace(SLIDER, **slider))


def transient(**more: object) -> Ask:
    """From rest by a method."""
    return lambda: problems.transient(CANTILEVER, FORCES, HERTZ, (1e-5,), LINKS, **more)  # type: ignore[arg-type]


def leaving(start: float, links: int, speed: float = -0.01) -> Ask:
    """A slider that starts somewhere on a chain of so many links with a speed."""
    slider = Slider(mass=1e-3, mu=0.2, slope=100.0, coupling="one-way", position=start, speed=speed)
    return lambda: ride.ride_from_rest(STRIP, FORCES, HERTZ, slider, links, 4e-3, step=2e-4)


def _loops() -> Iterator[Call]:
    """Of a chain, and of a slider that goes on it."""
    from verify.motion.warm import on_chain

    yield from warm.rigid()
    yield from warm.stretching()
    yield from on_chain("tanh")


ROWS: tuple[Row, ...] = (
    refusals(
        "refused-chains",
        "What no nonlinear chain is made of",
        "chain/system.py, chain/modes.py, chain/problems.py: its supports, loads on its links, springs that hold.",
        Case("beam.supports = ('free', 'clamped')", built(held("free", "clamped")), built()),
        Case("beam.supports = ('pinned', 'clamped')", built(held("pinned", "clamped")), built(STRIP)),
        Case("wall = 'welded'", built(wall="welded"), built(wall="half")),
        Case("beam.loss_factor = 0.01", built(replace(CANTILEVER, loss_factor=0.01))),
        Case("beam.tension: the nonlinear chain", built(replace(CANTILEVER, tension=1.0))),
        Case("joint_dashpot = -1e-09", built(joint_dashpot=-1e-9), built(joint_dashpot=0.0)),
        Case(
            "force.position = 0.7301",
            built(forces=(PointForce(position=0.7301),)),
            built(forces=(PointForce(position=0.73),)),
        ),
        Case("chain.lengths of link 1 = 0.0", scaled("lengths", 0.0), scaled("lengths", 1e-6)),
        Case("chain.masses of link 1", scaled("masses", -1.0)),
        Case("chain.stiffness of link 1", scaled("stiffness", -1.0), scaled("stiffness", 0.0)),
        Case("chain.dashpots has the shape", with_(dashpots=STILL[:3]), with_(dashpots=STILL)),
        Case("chain.tip = 'pinned'", with_(tip="pinned"), with_(tip="roller")),
        Case("chain.axial_spring = 1.0 acts", with_(axial_spring=1.0), with_(axial_spring=1.0, tip="roller")),
        Case("chain.axial_spring = -1.0", with_(axial_spring=-1.0)),
        Case("chain.gravity = nan", with_(gravity=(0.0, nan)), with_(gravity=(0.0, -9.81))),
        Case("load.link = 7", loaded(7, 0.0), loaded(6, 0.0)),
        Case("load.link = 0", loaded(0, 0.0), loaded(1, 0.0)),
        Case("load.at = ", loaded(6, 1.001 * LINK), loaded(6, LINK)),
        Case("chain.actuators are 5", with_(actuators=5 * (ACTUATOR,)), with_(actuators=4 * (ACTUATOR,))),
        Case("load.frequency_hz = -1.0", lambda: LinkLoad(link=1, at=0.0, frequency_hz=-1.0)),
        Case("rotation.rate = nan", lambda: Rotation(rate=nan)),
        Case("actuator.frequency_hz = -1.0", lambda: Actuator(link=1, at=0.0, frequency_hz=-1.0)),
        Case(
            "beam.supports = ('pinned', 'pinned')", lambda: bending.bend(STRIP, 6), lambda: bending.bend(CANTILEVER, 6)
        ),
        Case("count = 1", lambda: bending.bend(CANTILEVER, 1), lambda: bending.bend(CANTILEVER, 2)),
        Case(
            "load = (1.0, 2.0, 3.0)",
            lambda: bending.bend(CANTILEVER, 6, (1.0, 2.0, 3.0)),
            lambda: bending.bend(CANTILEVER, 6, (1.0, 2.0)),
        ),
        Case("moment = nan", lambda: bending.bend(CANTILEVER, 6, moment=nan)),
        Case("segments = 20001", lambda: bending.bend(CANTILEVER, 20_001)),
        Case("state.rates", straight(MOVING), straight()),
        Case("state.angles", straight(links=5)),
        Case(
            "rotation.rate = 3.0: gravity",
            straight(rotation=Rotation(rate=3.0), gravity=(0.0, -9.81)),
            straight(rotation=Rotation(rate=3.0)),
        ),
        Case(
            "mode = 4: a hanging chain",
            lambda: problems.hanging_frequency(4, 3),
            lambda: problems.hanging_frequency(3, 3),
        ),
        Case(
            "mode = 7: a chain of 6",
            lambda: problems.turning_frequency(7, 6, 3.0),
            lambda: problems.turning_frequency(6, 6, 3.0),
        ),
        Case(
            "beam.supports = ['clamped', 'free']: this figure",
            lambda: problems.large_amplitude_frequency(CANTILEVER, 2.0, LINKS),
        ),
        Case("amplitude: the middle would", lambda: problems.large_amplitude_frequency(STRIP, 200.0, LINKS)),
        Case("beam.section: the first mode", lambda: problems.large_amplitude_frequency(STEPPED, 2.0, LINKS)),
        Case("beam.shape: this figure takes a section", lambda: problems.large_amplitude_frequency(PLAIN, 2.0, LINKS)),
        Case("slider.coupling = 'two-way'", ridden(coupling="two-way"), ridden(coupling="one-way")),
        Case("slider.line = 'raw'", ridden(line="raw")),
        Case("beam.supports = ['pinned', 'pinned']", ridden(on=STRIP)),
        Case("beam.supports = ['clamped', 'free'], beam.length = 0.74", ridden(on=replace(CANTILEVER, length=0.74))),
        Case("chain.rotation", ridden(chain(rotation=Rotation(rate=1.0)))),
    ),
    refusals(
        "refused-chain-motions",
        "Motions of the nonlinear chain that are not begun",
        "docstrings of chain/stepping.py, splitting.py, stretching.py, work.py: methods, steps, times and work.",
        Case("method = 'euler'", stepped(method="euler")),
        Case("step = None", stepped(method="rk4")),
        Case("step = 1e-06: give a step in seconds with", stepped(step=1e-6)),
        Case("step = 0.0", stepped(method="rk4", step=0.0)),
        Case("step = 1e-06 s lies above", stepped(method="rk4", step=1e-6, limit=9.9e-7)),
        Case("tolerance = 0.1", stepped(tolerance=0.1)),
        Case("tolerance = 0.0", stepped(tolerance=0.0)),
        Case("times", stepped(())),
        Case("times", stepped((2e-5, 1e-5))),
        Case("times", stepped((1e-5, 1e-5))),
        Case("times", stepped((-1e-5, 1e-5))),
        Case("times", stepped((1e-5, nan))),
        Case("time = 1 s takes", stepped((0.0, 1.0), method="rk4", step=1e-6, limit=1.0, most=1e3)),
        Case("step = 0.0", split(step=0.0)),
        Case("kicks = 4", split(kicks=4)),
        Case("kicks = 0", split(kicks=0)),
        Case("n_modes = 7: there are", split(n_modes=7)),
        Case("n_modes = 0: there are", split(n_modes=0)),
        Case("chain.dashpots up to 0.001", split(dashpots=True, n_modes=3)),
        Case("chain.dashpots up to 0.001", lambda: splitting.simulate_linear(damped(), damped().rest, TIMES)),
        Case("times: give two or more, evenly", linear(0.0, 1e-5, 3e-5), linear(0.0, 1e-5, 2e-5)),
        Case("times: give two or more, evenly", linear(0.0), linear(0.0, 1e-5)),
        Case(
            "n_modes: the lowest modes alone are those about",
            lambda: splitting.modal_basis(chain(), dynamics.at_rest(chain()), 3),
            lambda: splitting.modal_basis(chain(), None, 3),
        ),
        Case("chain: actuators", lambda: splitting.modal_basis(chain(actuators=(ACTUATOR,)))),
        Case(
            "n_modes: the lowest modes alone are those of",
            lambda: splitting.modal_basis(chain(gravity=(0.0, -9.81)), None, 3),
        ),
        Case(
            "n_modes = 7: the chain has",
            lambda: splitting.modal_basis(chain(), None, 7),
            lambda: splitting.modal_basis(chain(), None, 6),
        ),
        Case(
            "chain.stiffness has joints",
            lambda: splitting.modal_basis(chain(stiffness=np.append(chain().stiffness[:-1], 0.0)), None, 3),
        ),
        Case("axial_stiffness has the shape", stretched(newton=np.ones(5))),
        Case("axial_stiffness = 0.0", stretched(newton=0.0)),
        Case("step = 1.0 s lies above", stretched(step=1.0)),
        Case("step = 0.0", stretched(step=0.0)),
        Case("times: give two or more, evenly spaced, from 0", stretched((0.0,))),
        Case("times: give two or more, evenly spaced, from 0", stretched((1e-6, 2e-6))),
        Case("times: give two or more, evenly spaced, from 0", stretched((0.0, 1e-6, 3e-6))),
        Case("chain.axial_inertia = False", stretched(of=chain(axial_inertia=False))),
        Case("chain.axial_spring = ", stretched(of=build_system(STRIP, LINKS, immovable=True))),
        Case("chain: actuators", stretched(of=chain(actuators=(ACTUATOR,)))),
        Case("time = 1 s takes", stretched((0.0, 1.0), most=1e3)),
        Case("step of the stretching chain = 9.8", pulled(300.0), pulled(100.0)),
        Case("step is missing", transient(method="rk4")),
        Case("step = 1e-06 is for", transient(step=1e-6)),
        Case("tolerance = 1e-09 is for", transient(method="linear", tolerance=1e-9), transient(method="linear")),
        Case("segments = 100001", lambda: problems.transient(CANTILEVER, FORCES, HERTZ, (1e-5,), 100_001)),
        Case("duration = 0.0", lambda: ride.half_steps(0.0, 1e-5), lambda: ride.half_steps(1e-4, 1e-5)),
        Case("step = 0.0", lambda: ride.half_steps(1e-4, 0.0)),
        Case(
            "links = 'soft'",
            lambda: ride.ride_from_rest(CANTILEVER, FORCES, HERTZ, SLIDER, LINKS, 1e-4, step=1e-5, links="soft"),  # type: ignore[arg-type]
        ),
        Case(
            "slider.coupling = 'auto'",
            lambda: ride.ride_from_rest(CANTILEVER, FORCES, HERTZ, SLIDER, LINKS, 1e-4, step=1e-5),
        ),
        Case("the slider left the piece of the chain it began on", leaving(0.365, 24), leaving(0.365, 25)),
        Case(
            "the slider left the piece of the chain it began on after 0.0",
            leaving(0.325, 25, -3.0),
            leaving(0.325, 3, -3.0),
        ),
        Case("time = 1.0 s would keep", lambda: check_kept(1e9, LINKS, "time = 1.0 s")),
        Case("time = 2 s takes", lambda: refuse_work(1001.0, 1000.0, 2.0), lambda: refuse_work(1000.0, 1000.0, 2.0)),
        kernels=_loops,
    ),
)
