"""What a scene will run, what it will not, and why: known before anything is solved."""

from typing import TYPE_CHECKING

import msgspec

from verify.errors import InputError
from verify.judge.workbench import Key, Need, Settings, merged, model_module

if TYPE_CHECKING:
    from verify.beam import Beam
    from verify.models.fields import HarmonicField
    from verify.scenes.scene import AxialInertia, Scene, Wave
    from verify.slider import Slider

CHAIN_IN_TIME = (
    "chain.energy_drift",
    "chain.large_amplitude_frequency",
    "chain.transient_deflection",
    "chain.axial_departure",
    "chain.slider_displacement",
    "chain.slider_mean_speed",
    "chain.slider_largest_friction",
    "chain.slider_imbalance",
)
"""Quantities of the nonlinear chain that are stepped; its others are equilibria and modes."""
STEPS_PER_RADIAN = 15
"""Of a chain's fastest mode, which the tolerance of the study of axial inertia takes."""
STUDIES = ("spectrum", "convergence", "sensitivity", "wave", "motion", "readings", "axial_inertia")
"""What a scene can ask for besides gates, by the name of its table."""


class Ask(msgspec.Struct, frozen=True):
    """Somebody who wants figures, and the solves behind them."""

    who: str
    needs: tuple[Need, ...]
    problem: str = ""
    """Why it cannot be evaluated; empty where it can."""


class PlannedSolve(msgspec.Struct, frozen=True, kw_only=True):
    """One solve, done once for all who asked."""

    model: str
    count: int
    settings: Settings
    n_modes: int
    unknowns: int
    method: str
    asked_by: tuple[str, ...]


class Skipped(msgspec.Struct, frozen=True):
    """Something this scene does not pay for."""

    what: str
    why: str


class Problem(msgspec.Struct, frozen=True):
    """Something asked that will fail, known beforehand."""

    who: str
    why: str


class Plan(msgspec.Struct, frozen=True, kw_only=True):
    """Everything `verify plan` prints."""

    scene: str
    solves: tuple[PlannedSolve, ...]
    closed_forms: tuple[str, ...]
    harmonic: tuple[str, ...]
    """Who asks for a driven field, solved when asked for."""
    stepped: tuple[str, ...]
    """Who asks for motion in time: friction and sliders by steps, a beam alone in closed form."""
    chosen: tuple[Skipped, ...]
    """Simpler models taken where the neglected part is small, with its size."""
    skipped: tuple[Skipped, ...]
    problems: tuple[Problem, ...]
    compiled: tuple[str, ...] = ()
    """Who asks for equilibria or modes of the nonlinear chain."""


def asks_of(scene: "Scene", *, gates_only: bool = False) -> list[Ask]:
    """Everything in a scene that wants a figure."""
    asks = []
    for gate in scene.gate:
        from verify.run.gates import gate_needs

        try:
            asks.append(Ask(f"gate {gate.id}", gate_needs(gate, scene)))
        except InputError as error:
            asks.append(Ask(f"gate {gate.id}", (), str(error)))
    return asks if gates_only else asks + _claim_asks(scene) + _study_asks(scene)


def _claim_asks(scene: "Scene") -> list[Ask]:
    asks = []
    for claim in scene.claim:
        from verify.studies.claims import claim_needs

        try:
            asks.append(Ask(f"claim {claim.id}", claim_needs(claim, scene)))
        except InputError as error:
            asks.append(Ask(f"claim {claim.id}", (), str(error)))
    return asks


def _study_asks(scene: "Scene") -> list[Ask]:
    asks = []
    models = ("segment", "fem")
    if scene.spectrum:
        size = scene.spectrum
        asks.append(Ask("spectrum", tuple(Need(m, size.count, size.modes) for m in models)))
    if scene.convergence:
        modes, counts = scene.convergence.modes, scene.convergence.counts
        asks.append(Ask("convergence", tuple(Need(m, count, max(modes)) for count in counts for m in models)))
    if scene.sensitivity:
        asks.append(Ask("sensitivity", ()))
    if scene.wave:
        asks.append(Ask(_wave_study(scene.wave), ()))
    if scene.motion and scene.slider:
        asks.append(Ask(_motion_study(scene), ()))
    if scene.readings:
        asks.append(Ask(_readings_study(scene), ()))
    if scene.axial_inertia:
        asks.append(Ask(_axial_study(scene, scene.axial_inertia), ()))
    return asks


def plan_scene(scene: "Scene") -> Plan:
    """What will be solved, evaluated in closed form, or skipped."""
    asks = asks_of(scene)
    solves, problems = [], [(ask.who, ask.problem) for ask in asks if ask.problem]
    for key, n_wanted in sorted(merged(need for ask in asks for need in ask.needs).items()):
        who = tuple(a.who for a in asks if any((n.model, n.count, n.settings) == key for n in a.needs))
        try:
            solves.append(_planned(scene, key, n_wanted, who))
        except InputError as error:
            problems += [(one, str(error)) for one in who]
    driven, timed, compiled = _driven(scene), _timed(scene), _compiled(scene)
    closed = tuple(a.who for a in asks if not a.needs and not a.problem and a.who not in driven | timed | compiled)
    return Plan(
        scene=scene.name,
        solves=tuple(solves),
        closed_forms=closed,
        skipped=_skipped(scene, asks),
        harmonic=tuple(ask.who for ask in asks if ask.who in driven and not ask.problem),
        stepped=tuple(ask.who for ask in asks if ask.who in timed and not ask.problem),
        chosen=_chosen(scene),
        compiled=tuple(ask.who for ask in asks if ask.who in compiled and not ask.problem),
        problems=tuple(Problem(*pair) for pair in problems),
    )


def _driven(scene: "Scene") -> set[str]:
    """Who asks for driven fields: gates and claims on waves and the wave study."""
    gates = {who for who, quantity in _asked(scene) if quantity.startswith("wave.")}
    return gates | ({_wave_study(scene.wave)} if scene.wave else set())


def _wave_study(wave: "Wave") -> str:
    sizes = ", ".join(str(n) for n in wave.counts)
    return f"wave (harmonic fields of segments and elements at N = {sizes}, one map)"


def _timed(scene: "Scene") -> set[str]:
    """Who asks for motion in time."""
    prefixes = ("friction.", "slider.", "motion.")
    gates = {who for who, name in _asked(scene) if name.startswith(prefixes) or name in CHAIN_IN_TIME}
    gates |= {_motion_study(scene)} if scene.motion and scene.slider else set()
    gates |= {_readings_study(scene)} if scene.readings else set()
    return gates | ({_axial_study(scene, scene.axial_inertia)} if scene.axial_inertia else set())


def _compiled(scene: "Scene") -> set[str]:
    """Who asks for the nonlinear chain at rest: its equilibria and modes, by compiled kernels without stepping."""
    return {who for who, quantity in _asked(scene) if quantity.startswith("chain.")} - _timed(scene)


def _asked(scene: "Scene") -> list[tuple[str, str]]:
    """(who, quantity) of every gate and every claim."""
    return [
        (f"{table} {one.id}", one.quantity)
        for table, ones in (("gate", scene.gate), ("claim", scene.claim))
        for one in ones
    ]


def _readings_study(scene: "Scene") -> str:
    asked = scene.readings
    assert asked is not None
    assert scene.motion is not None
    chain = f" and {asked.n_chain(scene)} on the nonlinear chain" if asked.chain else ""
    return (
        f"readings ({asked.n_readings} readings of the slider{chain}, {asked.n_runs(scene)} runs of {asked.model} "
        f"at N = {asked.count or scene.motion.count} of about {asked.n_steps(scene):.3g} steps, "
        f"{min(asked.shown, asked.n_groups)} on the exact beam beside)"
    )


def _motion_study(scene: "Scene") -> str:
    assert scene.motion is not None
    sizes = ", ".join(str(n) for n in scene.motion.counts)
    return f"motion (slider on segments, elements and the exact beam, work against error at N = {sizes})"


def _axial_study(scene: "Scene", asked: "AxialInertia") -> str:
    fastest = 4.0 * 3.0**0.5 * (asked.count / scene.beam.length) ** 2 * scene.beam.wave_constant
    forces = ", ".join(f"{force:g}" for force in asked.forces)
    runs = 3 * len(asked.forces) + 3
    steps = max(STEPS_PER_RADIAN * fastest * asked.duration, 1.0)
    return (
        f"axial_inertia (rigid, massless along x and stretching links at {forces} N, all models at "
        f"{asked.shown:g} N: {runs} runs of N = {asked.count}, about {steps:.2g} steps each)"
    )


def _chosen(scene: "Scene") -> tuple[Skipped, ...]:
    """How a slider is coupled and whether the chain may be linear, by size."""
    slider = scene.slider if _slides(scene) else None
    if not (slider or scene.axial_inertia) or not scene.forces or scene.beam.stepped:
        return ()
    from verify.exact.modes import solve_harmonic

    assert scene.drive is not None
    try:
        field = solve_harmonic(_damped(scene), scene.forces, scene.drive.frequency_hz)
    except InputError:
        return ()
    chosen = () if slider is None else (*_coupling(slider, field), _linear(field))
    return chosen if scene.axial_inertia is None else (*chosen, _over_the_force(scene, scene.axial_inertia))


def _damped(scene: "Scene") -> "Beam":
    """The beam with what stands in for its loss factor in time: twice the ratio of every mode."""
    from msgspec.structs import replace

    ratio = scene.motion.modal_damping if scene.motion else None
    return scene.beam if ratio is None else replace(scene.beam, loss_factor=2.0 * ratio)


def _slides(scene: "Scene") -> bool:
    """Whether anything runs the scene's slider."""
    return bool(scene.motion or scene.readings) or any(name.startswith("slider.") for _, name in _asked(scene))


def _coupling(slider: "Slider", field: "HarmonicField") -> tuple[Skipped, ...]:
    """One-way or two-way, and that a slider without normal inertia is a simplification."""
    from verify.beam import PointForce
    from verify.exact.modes import solve_harmonic
    from verify.motion.contact import FELT, coupling_of, surface_speed

    x = slider.start_on(field.beam)
    felt = solve_harmonic(field.beam, (PointForce(position=x),), field.frequency_hz).deflection([x])[0]
    found = coupling_of(slider, field.beam, field.frequency_hz, surface_speed(field, x), felt)
    chosen = Skipped(
        f"{'two' if found.two_way else 'one'}-way coupling",
        found.told + (", as slider.coupling says" if found.forced else f" (felt from {FELT:g} on)"),
    )
    return (chosen, Skipped("slider that the beam does not carry", found.simplified)) if found.simplified else (chosen,)


def _linear(field: "HarmonicField") -> Skipped:
    """A slider's run is on the linear chain whatever the size, which is said."""
    from verify.motion.validity import NONLINEAR

    size = _size(field)
    linear = "linear chain with an exact step" if size <= NONLINEAR else "linear chain, although"
    return Skipped(
        linear,
        f"axial inertia of a roller-ended chain, (kL)^2 <theta^2> = {size:.1e} of the motion "
        f"(felt from {NONLINEAR:g} on)",
    )


def _over_the_force(scene: "Scene", asked: "AxialInertia") -> Skipped:
    """Up to which force the linear chain will do: linear or nonlinear is decided by that number."""
    from msgspec.structs import replace

    from verify.exact.modes import solve_harmonic
    from verify.motion.validity import NONLINEAR

    assert scene.drive is not None
    forces = [replace(force, amplitude=1.0) for force in scene.forces]
    size = _size(solve_harmonic(scene.beam, forces, scene.drive.frequency_hz))
    sizes = ", ".join(f"{size * force**2:.1e} at {force:g} N" for force in asked.forces)
    limit = f"up to {(NONLINEAR / size) ** 0.5:.2g} N, nonlinear above" if size else "at any force"
    return Skipped(
        f"linear chain {limit}",
        f"decided by the axial inertia, (kL)^2 <theta^2> of the steady field: {sizes} (felt from {NONLINEAR:g} on)",
    )


def _size(field: "HarmonicField") -> float:
    """(kL)^2 <theta^2>, averaged over the beam and a period."""
    import numpy as np

    from verify.motion.validity import axial_inertia_size

    slopes = abs(field.slope(np.linspace(0.0, field.beam.length, 400)))
    return axial_inertia_size(field.beam, field.frequency_hz, 0.5 * float((slopes**2).mean()))


def _driven_elements(scene: "Scene") -> bool:
    """Whether a driven field of the finite elements is asked for."""
    prefixes = ("wave.", "slider.", "motion.")
    asking = [(one.quantity, one.arguments) for one in scene.gate] + [(c.quantity, c.arguments) for c in scene.claim]
    gates = any(name.startswith(prefixes) and given.get("model") == "fem" for name, given in asking)
    return any(study is not None for study in (scene.wave, scene.motion, scene.axial_inertia)) or gates


def _planned(scene: "Scene", key: Key, n_wanted: int, who: tuple[str, ...]) -> PlannedSolve:
    model, count, settings = key
    module = model_module(model)
    n_modes = max(min(n_wanted, module.n_elastic(scene.beam, count)), 1)
    module.check(scene.beam, n_modes, count, **dict(settings))
    return PlannedSolve(
        model=model,
        count=count,
        settings=settings,
        n_modes=n_modes,
        unknowns=module.unknowns(scene.beam, count),
        asked_by=who,
        method=module.method(scene.beam, n_modes, count),
    )


def _skipped(scene: "Scene", asks: list[Ask]) -> tuple[Skipped, ...]:
    """What this scene leaves out, with the reason."""
    left = []
    driven, compiled = _driven(scene), _compiled(scene)
    if not driven and not compiled and not _timed(scene) and not any(ask.needs for ask in asks):
        left.append(Skipped("numpy, scipy, scikit-fem", "nothing asked needs a discrete model: closed forms only"))
    elif not _driven_elements(scene) and not any(need.model == "fem" for ask in asks for need in ask.needs):
        left.append(Skipped("scikit-fem", "nothing asked needs the finite-element model"))
    if scene.drive is None:
        left.append(Skipped("harmonic response", "the scene has no drive"))
    elif not driven:
        left.append(Skipped("harmonic response", "no gate and no study asks for the driven beam"))
    timed = _timed(scene)
    if not timed:
        left.append(Skipped("time stepping", "modes and harmonic fields only: linear, nothing depends on the past"))
        left += [] if compiled else [Skipped("numba", "nothing asked is stepped")]
    if scene.slider is None:
        left.append(Skipped("contact search", "the scene has no slider"))
    elif not _slides(scene):
        left.append(Skipped("slider", "nothing runs it: add [motion] with a duration"))
    left += [] if scene.claim else [Skipped("published claims", "the scene has no [[claim]]")]
    studies = {name: getattr(scene, name) for name in STUDIES}
    left += [Skipped(f"{name} study", f"the scene has no [{name}]") for name, asked in studies.items() if not asked]
    return tuple(left)
