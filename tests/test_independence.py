"""What the models share is held by gates whose expected figure needs none of it.

Agreement of two models is no evidence about what both go through. For every module that they share the table below
plants faults in it and names a packaged gate that has to turn red; what that gate expects is worked out again here,
by formulas that import nothing of the suite. A fault that is never reached, because its seam has moved, fails too.
"""

import ast
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import carried_reference
import faults.everything  # noqa: F401
import msgspec
import numpy as np
import pytest
from msgspec.structs import replace
from scipy.optimize import brentq
from sources import PACKAGE, calls_of, nodes_of, paths
from stepped_reference import written_out

import verify
from verify.beam import Beam
from verify.elements.linear import buckling_load as load_of_elements
from verify.exact.buckling import buckling_load
from verify.field_docs import Value
from verify.run.gates import judge
from verify.run.runner import workbench_for
from verify.scenes.scene import Complex, load_scene
from verify.segments.buckling import buckling_load as load_of_segments

L, WIDTH, H, E, RHO, HERTZ, D = 0.5, 0.02, 0.001, 70e9, 2700.0, 4276.0, 0.0116
"""The paper's beam, as its scenes state it."""
EI, LINE = E * WIDTH * H**3 / 12, RHO * WIDTH * H
OMEGA = 2 * np.pi * HERTZ
K = (LINE * OMEGA**2 / EI) ** 0.25
DRIVES = ((D, 0.0), (L - D, 90.0))


def pinned_omega(n):
    return (n * np.pi / L) ** 2 * np.sqrt(EI / LINE)


def modal_sum(x, drives, eta=0.0, ratio=0.0):
    """The pinned beam's steady deflection under 1 N at each (place, phase in degrees), by 200 000 modes, metres."""
    n = np.arange(200_000.0, 0.0, -1.0)
    own = pinned_omega(n)
    answers = np.sin(n * np.pi * x / L) / (own**2 * (1 + 1j * eta) - OMEGA**2 + 2j * ratio * own * OMEGA)
    return complex(
        sum(
            2 / (LINE * L) * np.exp(1j * np.deg2rad(phase)) * (np.sin(n * np.pi * place / L) * answers).sum()
            for place, phase in drives
        )
    )


def from_rest(x, time, grow_s):
    """The pinned beam from rest under forces that grow as 3 p^2 - 2 p^3, metres.

    By Duhamel's integral of 150 modes; those above, fifty times as fast as the drive, follow it.
    """
    points, weights = np.polynomial.legendre.leggauss(12)
    edges = np.concatenate([np.linspace(0, grow_s, 400), np.linspace(grow_s, time, 400)[1:]])
    half = 0.5 * np.diff(edges)
    t = (edges[:-1, None] + half[:, None] * (points + 1)).ravel()
    p = np.minimum(t / grow_s, 1.0)
    total = 0.0
    for n in range(1, 20_001):
        shape, own = 2 / (LINE * L) * np.sin(n * np.pi * x / L), pinned_omega(n)
        shares = [(np.sin(n * np.pi * place / L), np.deg2rad(phase)) for place, phase in DRIVES]
        if n > 150:
            push = sum(share * np.cos(OMEGA * time + phase) for share, phase in shares)
            total += shape * push / (own**2 - OMEGA**2)
            continue
        pushes = sum(share * np.cos(OMEGA * t + phase) for share, phase in shares)
        kernel = p * p * (3 - 2 * p) * pushes * np.sin(own * (time - t)) / own
        total += shape * float(kernel @ (half[:, None] * weights).ravel())
    return total


def link_omega2(mu):
    """Of rigid links with half a wave of mu on each, in EI / (rho A l^4)."""
    s2 = np.sin(mu / 2) ** 2
    return 48 * s2**2 / (3 - 2 * s2)


def link_wavenumber(count):
    return float(
        brentq(lambda k: link_omega2(k * L / count) * (count / L) ** 4 - LINE * OMEGA**2 / EI, 0.9 * K, 1.1 * K)
    )


def hermite_wavenumber(count, hertz=HERTZ):
    """From the two nodal equations of equal Hermite elements."""
    part, here = L / count, K * np.sqrt(hertz / HERTZ)

    def determinant(k):
        c, s, m = np.cos(k * part), np.sin(k * part), (here * part) ** 4 / 420
        ww, tt = 24 * (1 - c) - m * (312 + 108 * c), 8 + 4 * c - m * (8 - 6 * c)
        wt = 12 * s + m * 26 * s
        return ww * tt - wt**2

    return float(brentq(determinant, 0.99 * here, 1.01 * here))


def gamma(turn, phase=0.5 * np.pi):
    """The weaker over the stronger wave between two equal forces `turn` = kL apart."""
    sizes = sorted(abs(np.sin(0.5 * (turn + side * phase))) for side in (1, -1))
    return sizes[0] / sizes[1]


def swr(weaker):
    return (1 + weaker) / (1 - weaker)


def imposed_ratio():
    """Standing-wave ratio under two displacements a quarter turn apart, from the static and wave parts of Green's function."""

    def green(x, place):
        a, b = min(x, place), max(x, place)
        wave, near = (f(K * a) * f(K * (L - b)) / f(K * L) for f in (np.sin, np.sinh))
        return (wave - near) / (2 * EI * K**3)

    places = (D, L - D)
    first, second = np.linalg.solve([[green(x, p) for p in places] for x in places], [1.0, 1.0j])
    sizes = sorted((abs(first * np.exp(1j * K * L) - second), abs(second - first * np.exp(-1j * K * L))))
    return swr(sizes[0] / sizes[1])


def free_node():
    """Where the first mode of a free bar of 0.42 m stands still, m."""
    y = brentq(lambda y: np.cos(y) * np.cosh(y) - 1, 4.0, 5.0)
    share = (np.cosh(y) - np.cos(y)) / (np.sinh(y) - np.sin(y))
    return 0.42 * brentq(lambda z: np.cosh(y * z) + np.cos(y * z) - share * (np.sinh(y * z) + np.sin(y * z)), 0.1, 0.4)


def drift_against_the_wave():
    """-k omega A^2 (1 + (k h/2)^2) of a steep slider on a pure wave of A = F |sin kd| / (2 EI k^3), m/s."""
    amplitude = abs(np.sin(K * D)) / (2 * EI * K**3)
    return -K * OMEGA * amplitude**2 * (1 + (0.5 * K * H) ** 2)


def strip(model):
    """The ninth frequency of the patched strip on 1, 1, 20, 1, 1 parts, Hz."""
    stiffness, mass = written_out(model, (1, 1, 20, 1, 1), 1.0)
    return float(np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)[8]) / (2 * np.pi))


def per_hertz():
    """Change of the elements' reflection over half a hertz on both sides."""
    back, here, ahead = (gamma(hermite_wavenumber(98, HERTZ + step) * L) for step in (-0.5, 0.0, 0.5))
    return abs(ahead - here) + abs(here - back)


@dataclass(frozen=True)
class Shared:
    """A fault in a module that models share, and the gate that is to notice."""

    module: str
    fault: str
    seams: tuple[str, ...]
    """Where the fault sits: attributes below verify, as their users look them up."""
    planted: Callable[[Any], Any]
    """The true thing -> the faulty one."""
    scene: str
    gates: tuple[str, ...]
    reference: Callable[[], complex]
    """What those gates expect, by nothing of the suite."""


def after(change):
    """A fault in what a function returns."""
    return lambda true: lambda *given, **more: change(true(*given, **more))


def before(change):
    """A fault in what a function is given first."""
    return lambda true: lambda first, *given, **more: true(change(first), *given, **more)


def second_argument(change):
    return lambda true: lambda first, second, *given, **more: true(first, change(second), *given, **more)


def heavier(values_and_vectors):
    values, vectors = values_and_vectors
    return 1.0002 * values, vectors


SHARED = [
    Shared(
        "beam",
        "the constant of its waves a ten-thousandth too large",
        ("beam.Beam.wave_constant",),
        lambda true: property(lambda beam: 1.0001 * true.fget(beam)),
        "paper",
        ("exact-mode-22",),
        lambda: pinned_omega(22) / (2 * np.pi),
    ),
    Shared(
        "section",
        "a section a hundredth too heavy",
        ("beam._pieces",),
        after(lambda pieces: tuple(replace(p, mass_per_length=1.01 * p.mass_per_length) for p in pieces)),
        "patched-strip",
        ("elements-at-24",),
        lambda: strip("fem"),
    ),
    Shared(
        "attached",
        "rotary inertias a hundredth too large",
        ("attached.PointMass.rotary_inertia",),
        lambda true: property(lambda body: 1.01 * true.__get__(body)),
        "instrument-arm",
        ("elements-at-40",),
        lambda: carried_reference.arm_by_elements(4, (15, 25)),
    ),
    Shared(
        "attached",
        "masses a thousandth too heavy",
        ("attached.PointMass.mass",),
        lambda true: property(lambda body: 1.001 * true.__get__(body)),
        "instrument-arm",
        ("levers-at-40",),
        lambda: carried_reference.arm_by_levers(1, 40),
    ),
    Shared(
        "attached",
        "springs a thousandth too stiff",
        ("attached.PointSpring.rotational", "attached.PointSpring.stiffness"),
        lambda true: property(lambda spring: 1.001 * true.__get__(spring)),
        "instrument-arm",
        ("elements-at-40",),
        lambda: carried_reference.arm_by_elements(4, (15, 25)),
    ),
    Shared(
        "exact.closed_forms",
        "roots of one half wave too many",
        ("exact.closed_forms.root_parts",),
        second_argument(lambda mode: mode + 1),
        "paper",
        ("segment-mode-22",),
        lambda: np.sqrt(link_omega2(22 * np.pi / 49)) / (22 * np.pi / 49) ** 2 - 1,
    ),
    Shared(
        "models.division",
        "each part takes the stiffness of its neighbour",
        ("elements.cuts.divide",),
        after(lambda parts: replace(parts, moduli=np.roll(parts.moduli, 1))),
        "patched-strip",
        ("elements-at-24",),
        lambda: strip("fem"),
    ),
    Shared(
        "models.division",
        "each part takes the mass of its neighbour",
        ("segments.assembly.divide",),
        after(lambda parts: replace(parts, masses_per_length=np.roll(parts.masses_per_length, 1))),
        "patched-strip",
        ("segments-at-24",),
        lambda: strip("segment"),
    ),
    Shared(
        "models.pencil",
        "values two ten-thousandths too large in the quotient",
        ("models.eigen.factored_quotient",),
        after(heavier),
        "paper",
        ("segment-mode-22",),
        lambda: np.sqrt(link_omega2(22 * np.pi / 49)) / (22 * np.pi / 49) ** 2 - 1,
    ),
    Shared(
        "models.eigen",
        "eigenvalues two ten-thousandths too large",
        ("segments.linear.lowest",),
        after(lambda pairs: replace(pairs, values=1.0002 * pairs.values)),
        "paper",
        ("segment-mode-22",),
        lambda: np.sqrt(link_omega2(22 * np.pi / 49)) / (22 * np.pi / 49) ** 2 - 1,
    ),
    Shared(
        "models.response",
        "a driven pencil at a slightly higher frequency",
        ("models.driven_pencil.forced_response",),
        lambda true: lambda pencil, loads, omega2, stiffness: true(pencil, loads, 1.0005 * omega2, stiffness),
        "paper-wave",
        ("loss-on-elements",),
        lambda: modal_sum(0.2137, DRIVES, 0.01),
    ),
    Shared(
        "models.response",
        "a driven pencil whose losses are conjugate",
        ("models.driven_pencil.forced_response",),
        lambda true: lambda pencil, loads, omega2, stiffness: true(pencil, loads, omega2, stiffness.conj()),
        "paper-wave",
        ("loss-on-elements",),
        lambda: modal_sum(0.2137, DRIVES, 0.01),
    ),
    Shared(
        "models.banded",
        "a driven band whose masses are half a thousandth too heavy",
        ("models.response.band_of",),
        after(lambda band: replace(band, masses=1.0005 * band.masses)),
        "paper-wave",
        ("loss-on-elements",),
        lambda: modal_sum(0.2137, DRIVES, 0.01),
    ),
    Shared(
        "models.driven_pencil",
        "damping ratios a tenth too large",
        ("elements.linear.damped_response",),
        lambda true: (
            lambda pencil, loads, omega2, stiffness, ratio: true(pencil, loads, omega2, stiffness, 1.1 * ratio)
        ),
        "paper-wave",
        ("ratio-on-elements",),
        lambda: modal_sum(0.2137, DRIVES, 0.004, 0.013),
    ),
    Shared(
        "models.driven_pencil",
        "shares of the modes without their losses",
        ("elements.linear.modal_receptance",),
        lambda true: lambda pencil, weights, omega2, eta: true(pencil, weights, omega2, 0.0),
        "paper-wave",
        ("receptance-of-elements",),
        lambda: modal_sum(0.2137, ((0.0731, 0.0),), 0.01),
    ),
    Shared(
        "models.modes",
        "shapes read a hundredth nearer to the left end",
        ("models.modes.Modes._on_beam",),
        lambda true: lambda modes, x: 0.99 * true(modes, x),
        "free-free-bar",
        ("node-by-segments",),
        free_node,
    ),
    Shared(
        "models.fields",
        "fields read a thousandth nearer to the left end",
        ("models.fields.HarmonicField._on_beam",),
        lambda true: lambda field, x: 0.999 * true(field, x),
        "paper-wave",
        ("loss-on-elements",),
        lambda: modal_sum(0.2137, DRIVES, 0.01),
    ),
    Shared(
        "models.places",
        "places on a shape a hundredth nearer to the left end",
        ("models.modes.places",),
        lambda true: lambda field, x, length: 0.99 * true(field, x, length),
        "free-free-bar",
        ("node-by-segments",),
        free_node,
    ),
    Shared(
        "models.places",
        "places on a field a thousandth nearer to the left end",
        ("models.fields.places",),
        lambda true: lambda field, x, length: 0.999 * true(field, x, length),
        "paper-wave",
        ("loss-on-elements",),
        lambda: modal_sum(0.2137, DRIVES, 0.01),
    ),
    Shared(
        "models.fields",
        "forces that lag instead of lead",
        ("elements.linear.phasor",),
        after(np.conj),
        "paper-wave",
        ("loss-on-elements",),
        lambda: modal_sum(0.2137, DRIVES, 0.01),
    ),
    Shared(
        "models.fields",
        "a wavenumber a ten-thousandth too large",
        ("exact.harmonic.wavenumber", "models.fields.wavenumber"),
        after(lambda k: 1.0001 * k),
        "paper-wave",
        ("swr-law",),
        lambda: swr(gamma(K * L)),
    ),
    Shared(
        "exact.error_laws",
        "waves of the links a thousandth too short",
        ("exact.error_laws.discrete_wavenumber",),
        after(lambda k: 1.001 * k),
        "paper-wave",
        ("segment-49-ratio",),
        lambda: swr(gamma(link_wavenumber(49) * L)),
    ),
    Shared(
        "device",
        "impedances a thousandth too large",
        ("device.Device.impedance",),
        after(lambda impedance: 1.001 * impedance),
        "absorbing-end",
        ("wave-with-its-device", "wave-with-its-device-on-segments", "wave-with-its-device-on-elements"),
        lambda: 0.0,
    ),
    Shared(
        "device",
        "impedances against turning a thousandth too large",
        ("device.Device.turning_impedance",),
        after(lambda impedance: 1.001 * impedance),
        "absorbing-end",
        ("exact-beam-against-turning", "segments-against-turning", "elements-against-turning"),
        lambda: 0.0,
    ),
    Shared(
        "waves.devices",
        "devices that pull a ten-thousandth too much",
        ("waves.devices._pulls",),
        after(lambda pulls: [1.0001 * pull for pull in pulls]),
        "absorbing-end",
        ("power-that-runs-to-the-device",),
        lambda: 0.5 * (OMEGA / (EI * K**3)) * 0.5 * np.sin(K * D) ** 2,
    ),
    Shared(
        "waves.measures",
        "the backward wave taken a tenth too small",
        ("waves.measures.wave_basis",),
        after(lambda basis: basis * np.array([1.0, 1.1])),
        "paper-wave",
        ("segment-49-ratio",),
        lambda: swr(gamma(link_wavenumber(49) * L)),
    ),
    Shared(
        "waves.imposed",
        "displacements imposed in phase",
        ("waves.imposed.phasor",),
        after(abs),
        "paper-wave",
        ("imposed-displacement",),
        imposed_ratio,
    ),
    Shared(
        "waves.unit_waves",
        "the second drive a hundredth stronger",
        ("waves.operating_point.superposed",),
        lambda true: lambda drive, names, f, first, second, gaps: true(drive, names, f, first, 1.01 * second, gaps),
        "paper-wave",
        ("reflection-per-hertz",),
        per_hertz,
    ),
    Shared(
        "models.search",
        "a minimum found a hundred-thousandth beside itself",
        ("waves.driven.least_over",),
        after(lambda found: replace(found, x=found.x * (1 + 1e-5))),
        "paper-wave",
        ("best-frequency",),
        lambda: (21.5 * np.pi / L) ** 2 * np.sqrt(EI / LINE) / (2 * np.pi),
    ),
    Shared(
        "judge.compare",
        "errors of twice their size",
        ("judge.compare.relative_error",),
        after(lambda error: 2 * error),
        "paper",
        ("segment-mode-22",),
        lambda: np.sqrt(link_omega2(22 * np.pi / 49)) / (22 * np.pi / 49) ** 2 - 1,
    ),
    Shared(
        "motion.forcing",
        "the forced part a ten-thousandth too large",
        ("motion.surface.answer",),
        after(lambda found: replace(found, amplitudes=1.0001 * found.amplitudes)),
        "paper-slider",
        ("beam-segments", "beam-elements"),
        lambda: from_rest(0.2137, 0.83e-3, 2 / HERTZ),
    ),
    Shared(
        "motion.forcing",
        "free modes that turn the other way",
        ("motion.surface.advanced",),
        lambda true: lambda modes, z, t: true(modes, z * np.array([[1.0], [-1.0]]), t),
        "paper-slider",
        ("beam-segments",),
        lambda: from_rest(0.2137, 0.83e-3, 2 / HERTZ),
    ),
    Shared(
        "motion.forcing",
        "loads of every mode a ten-thousandth too large",
        ("motion.surface.modal",),
        after(lambda modes: replace(modes, loads=1.0001 * modes.loads)),
        "paper-slider",
        ("beam-segments", "beam-elements"),
        lambda: from_rest(0.2137, 0.83e-3, 2 / HERTZ),
    ),
    Shared(
        "motion.surface",
        "a drive whose time is behind by a microsecond",
        ("motion.surface.Stage.drive_factors",),
        lambda true: lambda stage, t: true(stage, t - 1e-6),
        "paper-slider",
        ("beam-segments",),
        lambda: from_rest(0.2137, 0.83e-3, 2 / HERTZ),
    ),
    Shared(
        "models.time_basis",
        "polynomials of the surface three per cent too large",
        ("motion.surface.taylor_table",),
        after(lambda table: 1.03 * table),
        "paper-slider",
        ("slider-against-the-wave",),
        drift_against_the_wave,
    ),
    Shared(
        "motion.contact",
        "a lever forty times as long",
        ("motion.carried.law_of",),
        after(lambda law: law._replace(half=40.0 * law.half)),
        "paper-slider",
        ("slider-against-the-wave",),
        drift_against_the_wave,
    ),
]


def seam(path):
    """(what holds it, name) of an attribute below verify."""
    holder, (*rest, name) = verify, path.split(".")
    for part in rest:
        with suppress(ModuleNotFoundError):
            import_module(f"{holder.__name__}.{part}")
        holder = getattr(holder, part)
    return holder, name


def plant(monkeypatch, shared):
    """The fault in every seam; a list that grows whenever one is reached."""
    reached: list[str] = []
    for path in shared.seams:
        holder, name = seam(path)
        true = vars(holder)[name]
        faulty = shared.planted(true)

        called = faulty.fget if isinstance(faulty, property) else faulty

        def watched(*given, called=called, path=path, **more):
            reached.append(path)
            return called(*given, **more)

        monkeypatch.setattr(holder, name, property(watched) if isinstance(faulty, property) else watched)
    return reached


def verdicts(shared):
    scene = load_scene(shared.scene)
    bench = workbench_for(scene, gates_only=True)
    return {gate.id: judge(gate, scene, bench) for gate in scene.gate if gate.id in shared.gates}


def known(shared):
    return pytest.param(shared, id=f"{shared.module}: {shared.fault}")


@pytest.mark.parametrize("shared", [known(row) for row in SHARED])
def test_what_a_gate_expects_of_a_shared_module_is_known_without_the_suite(shared):
    """To three fifths of the gate's band: the rest is what the model itself leaves."""
    reference = shared.reference()
    gates = [gate for gate in load_scene(shared.scene).gate if gate.id in shared.gates]
    assert len(gates) == len(shared.gates)
    for gate in gates:
        expected = complex(gate.expect.re, gate.expect.im) if isinstance(gate.expect, Complex) else gate.expect
        assert abs(reference - expected) <= 0.6 * gate.within, gate.id


@pytest.mark.parametrize("shared", [known(row) for row in SHARED])
def test_a_fault_in_a_shared_module_turns_a_gate_red_that_does_not_share_it(shared, monkeypatch):
    reached = plant(monkeypatch, shared)
    found = verdicts(shared)
    missed = set(shared.seams) - set(reached)
    assert not missed, f"{missed} were never reached: the seam of this fault has moved, find it again"
    for gate, verdict in found.items():
        assert not verdict.passed, gate
        assert "cannot be evaluated" not in verdict.reason, verdict.reason


def test_the_gates_of_the_table_are_green_without_a_fault():
    for shared in SHARED:
        assert all(verdict.passed for verdict in verdicts(shared).values()), shared.fault


def imported(module, found):
    """The modules of the suite behind one, into `found`, lazily imported ones as well."""
    path = Path(verify.__file__).parent / f"{module.replace('.', '/')}.py"
    if module not in found and path.exists():
        found.add(module)
        for node in nodes_of(path):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("verify."):
                imported(node.module.removeprefix("verify."), found)
    return found


def in_use(path, name):
    """Calls of a check of which something comes: they do not stand alone."""
    if not (calls := calls_of(path, name)):
        return []
    alone = {id(node.value) for node in nodes_of(path) if isinstance(node, ast.Expr)}
    return [call for call in calls if id(call) not in alone]


PATIENCE = {
    "check_work": None,
    "check_taken": {"motion.stepping"},
    "patient": {"stress.modes.sizes", "stress.limits.judgements", "stress.motor.means", "stress.figures"},
    "own_limit": {"commands.stress", "cli", "pytest_plugin"},
    "waited_for": {"motor.figures", "motion.judged_step"},
    "PATIENCE_S": {"stress.refused.runs", "stress.figures"},
    "VARIABLE": {"motor.withheld"},
}
"""What is taken of `patience`, by whom where few may: its refusals, before work and on the way; a `with` in which minutes are waited for, which the
stress table opens around whole solves; what is waited for at most, to refuse what takes a little more; and the seconds that the
environment says, the cap of that table's command, which the doors ask for to refuse what is none."""


def test_work_is_estimated_to_be_refused_and_nothing_is_figured_with_it():
    """Nothing comes out of `patience` but a refusal: every call of it stands alone, and a wait binds no name.

    What `own_limit` gives goes to a command alone, and no model stands on a command or on the stress table. Means of a
    motor that have not settled are read over longer windows while that is `waited_for`, and refused or told with their
    spread where it is not, and a slider's step is halved likewise: it stands in the heads of these loops alone.
    """
    assert imported("patience", set()) == {"patience", "errors"}
    takers = set()
    for path in paths():
        for node in nodes_of(path):
            if isinstance(node, ast.ImportFrom) and node.module == "verify.patience":
                taker = ".".join(path.relative_to(PACKAGE).with_suffix("").parts)
                for alias in node.names:
                    assert alias.asname is None, taker
                    assert alias.name in PATIENCE, taker
                    assert taker in (PATIENCE[alias.name] or {taker}), alias.name
                takers.add(taker)
            assert not (isinstance(node, ast.Import) and any(a.name == "verify.patience" for a in node.names)), (
                path.stem
            )
        assert not in_use(path, "check_work"), path.stem
        assert not in_use(path, "check_taken"), path.stem
        heads = [call for node in nodes_of(path) if isinstance(node, ast.While) for call in ast.walk(node.test)]
        assert all(call in heads for call in calls_of(path, "waited_for")) or path.stem == "patience", path.stem
        unbound = [
            item.context_expr
            for node in nodes_of(path)
            if isinstance(node, ast.With)
            for item in node.items
            if item.optional_vars is None
        ]
        assert all(call in unbound for call in calls_of(path, "patient")), path.stem
    assert takers >= {"models.eigen", "stress.modes.sizes", "commands.stress"}
    faces = ("exact.modes", "exact.in_time", "elements.linear", "elements.in_time", "segments.linear")
    behind = set().union(*(imported(face, set()) for face in (*faces, "segments.in_time")))
    assert not {name for name in behind if name.startswith(("stress", "commands"))}


def test_numbers_are_checked_and_nothing_comes_of_it_but_a_refusal():
    assert imported("checks", set()) == {"checks", "errors"}
    for path in paths():
        for name in ("check_number", "check_whole"):
            assert not in_use(path, name), path.stem


def test_a_theory_is_checked_and_nothing_comes_of_it_but_a_refusal():
    """What a theory is, every model has of its own: of the shared module one name is taken, and calls stand alone."""
    takers = set()
    for path in paths():
        for node in nodes_of(path):
            if isinstance(node, ast.ImportFrom) and node.module == "verify.models.theory":
                assert [(alias.name, alias.asname) for alias in node.names] == [("check_theory", None)], path.stem
                takers.add(path.parent.name)
        assert not in_use(path, "check_theory"), path.stem
    assert takers == {"exact", "elements", "segments", "judge"}


def test_what_tells_help_of_fields_is_words_alone():
    """Neither a field nor a method comes from it: a value is a frozen struct like any other."""

    class Bare(msgspec.Struct, frozen=True):
        """The same without words."""

    assert imported("field_docs", set()) == {"field_docs"}
    assert not msgspec.structs.fields(Value)
    assert set(vars(Value)) ^ set(vars(Bare)) <= {"__annotations__", "__doc__"}  # made by Python when asked for


COLUMN = Beam(
    length=0.83, width=0.023, thickness=0.0031, youngs_modulus=71e9, density=2710.0, supports=["pinned", "pinned"]
)


def column_load(per_square):
    """Of equal parts of the column, from P l^2/EI of one part with half a wave over all of them."""
    stiffness = 71e9 * 0.023 * 0.0031**3 / 12
    return per_square * stiffness * (17 / 0.83) ** 2


def hermite_column(turn):
    """P l^2/EI of Hermite elements whose nodes lie on a sine: two nodal equations of textbook matrices."""
    bending, pulled, _ = carried_reference.hermite(1.0)
    carry = np.vstack([np.eye(2), np.eye(2) * np.exp(1j * turn)])
    stiff, axial = (carry.conj().T @ matrix @ carry for matrix in (bending, pulled))
    return min(np.linalg.eigvals(np.linalg.solve(axial, stiff)).real)


BUCKLING = {
    "elements": (load_of_elements, lambda: column_load(hermite_column(np.pi / 17))),
    "segments": (load_of_segments, lambda: column_load(4 * np.sin(np.pi / 34) ** 2)),
}
"""By model: its load, and the load of 17 parts by nothing of the suite."""


@pytest.mark.parametrize("model", BUCKLING)
def test_buckling_is_found_where_it_is_known_without_the_suite_and_not_where_a_fault_puts_it(model, monkeypatch):
    """`models.compression` says how near to buckling a compressed model is, which no gate asks."""
    found, reference = BUCKLING[model]
    assert abs(found(COLUMN, 17) / reference() - 1) < 1e-11
    assert abs(buckling_load(COLUMN) / column_load((np.pi / 17) ** 2) - 1) < 1e-13
    home = {"elements": "elements.pencil", "segments": "segments.buckling"}[model]
    true = import_module(f"verify.{home}").buckling_ratio
    monkeypatch.setattr(f"verify.{home}.buckling_ratio", lambda pencil: 1.001 * true(pencil))
    assert abs(found(COLUMN, 17) / reference() - 1) > 1e-4


NAMES_ALONE = ("models.arrays", "options")
"""Kinds of arrays and words to choose from."""
REFUSALS = ("patience", "checks", "models.theory")
"""What is called to refuse, and for nothing else."""


@pytest.mark.parametrize("name", NAMES_ALONE)
def test_what_is_shared_as_names_alone_holds_no_figure_and_does_nothing(name):
    assert imported(name, set()) == {name}
    tree = ast.parse((Path(verify.__file__).parent / f"{name.replace('.', '/')}.py").read_text("utf-8"))
    assert {type(node) for node in tree.body} <= {ast.ImportFrom, ast.Import, ast.Assign, ast.AnnAssign, ast.Expr}
    assert not [node for node in ast.walk(tree) if isinstance(node, ast.BinOp | ast.UnaryOp | ast.Lambda)]
    constants = [node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)]
    assert all(isinstance(value, str | type(...)) for value in constants)
    assert {getattr(node.func, "id", "") for node in ast.walk(tree) if isinstance(node, ast.Call)} <= {"get_args"}


def test_every_module_that_two_models_stand_on_is_in_the_table():
    """`errors` and `field_docs` carry words, `REFUSALS` refusals, `NAMES_ALONE` names: no figures, as the tests above hold.

    `models.compression` has a test of its own.
    """
    faces = (
        ("exact.modes", "exact.in_time"),
        ("elements.linear", "elements.in_time", "elements.stock"),
        ("segments.linear", "segments.in_time"),
    )
    behind = [set().union(*(imported(face, set()) for face in pair)) for pair in faces]
    shared = (behind[0] & behind[1]) | (behind[0] & behind[2]) | (behind[1] & behind[2])
    assert shared >= {
        "models.modes",
        "models.fields",
        "models.division",
        "models.eigen",
        "models.driven_pencil",
        "models.time_basis",
    }
    without = {"errors", "field_docs", *REFUSALS, *NAMES_ALONE, "models.compression"}
    # judged in 50 digits: the rows tip-mass and nearly-rigid of the stress table, tests/faults
    without |= {"models.polishing", "models.inverse"}
    assert shared - without <= {row.module for row in SHARED}
