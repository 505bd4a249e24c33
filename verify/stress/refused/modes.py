"""What no beam is, and what the three models refuse: modes, driven fields, laws in closed form."""

from collections.abc import Sequence
from math import pi, sqrt

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass, PointSpring
from verify.beam import Beam, PointForce
from verify.exact import closed_forms, error_laws
from verify.judge import compare
from verify.judge.extended_precision import chain_bands
from verify.judge.workbench import Settings, Workbench
from verify.models.catalogue import MODELS
from verify.section import Section
from verify.stress.kind import Row
from verify.stress.references.beams import PLAIN, STEPPED, STRIP, held
from verify.stress.refusals import Ask, Case, refusals

CANTILEVER, FREE, TURNS = held("clamped", "free"), held("free", "free"), held("pinned", "free")
TAUT, LOSSY = replace(STRIP, tension=12.0), replace(STRIP, loss_factor=0.02)
TURNING = replace(PLAIN, rotary_inertia=1e-7)
"""With what Rayleigh's theory takes, and Timoshenko's lacks."""
THREE = replace(STRIP, section=(Section(length=0.2), Section(length=0.2, thickness=0.003), Section(length=0.33)))
LOADED = replace(
    CANTILEVER, mass=(PointMass(position=0.31, mass=0.02),), spring=(PointSpring(position=0.5, stiffness=700.0),)
)
PARTS = 9
HERTZ = 37.0


def beam(**given: object) -> Ask:
    """The strip with other figures."""
    return lambda: replace(STRIP, **given)


def modes(model: str, n_modes: int, count: int | None = PARTS, of: Beam = STRIP, **settings: str | float) -> Ask:
    """Of a model of 9 parts, or of others."""
    return lambda: MODELS.named(model).solve_modes(of, n_modes, count, **settings)  # type: ignore[arg-type]


def hung(of: Beam, newton_per_metre: float) -> Beam:
    """On two springs."""
    springs = (PointSpring(position=at, stiffness=newton_per_metre) for at in (0.2, 0.5))
    return replace(of, spring=tuple(springs))


def field(
    model: str, of: Beam = STRIP, hertz: float = HERTZ, at: float = 0.3, newton: float = 1.0, **settings: str | float
) -> Ask:
    """Of a model of 9 parts under one force."""
    count = PARTS if MODELS[model].sized else None
    return lambda: MODELS[model].solve_harmonic(
        of, (PointForce(position=at, amplitude=newton),), hertz, count, **settings
    )


def reading(model: str, *x: object) -> Ask:
    """That field read at places."""
    count = PARTS if MODELS[model].sized else None
    forces = (PointForce(position=0.3),)
    return lambda: MODELS[model].solve_harmonic(STRIP, forces, HERTZ, count).deflection(list(x))  # type: ignore[arg-type]


def unforced(model: str) -> Ask:
    """Driven by nothing."""
    return lambda: MODELS[model].solve_harmonic(STRIP, (), HERTZ, PARTS if MODELS[model].sized else None)


def sweep(model: str, *hertz: float) -> Ask:
    """Fields at many frequencies."""
    count = PARTS if MODELS[model].sized else None
    return lambda: MODELS[model].sweep_harmonic(STRIP, (PointForce(position=0.3),), np.array(hertz), count)


def bracket(of: Beam, count: int = PARTS, settings: Settings = ()) -> Ask:
    """Segments below and elements above mode 2."""
    return lambda: Workbench(of).bracket(2, count, settings)


def order(counts: Sequence[int], *errors: float) -> Ask:
    """Observed on errors."""
    return lambda: compare.observed_order(counts, errors)


def carried(model: str, share: float) -> Ask:
    """A drive at a share of the frequency at which waves turn by pi from part to part."""
    top = sqrt(error_laws.law_of(model).root(pi)) * STRIP.wave_constant * (PARTS / STRIP.length) ** 2 / (2.0 * pi)
    return lambda: error_laws.check_carried(model, STRIP, PARTS, share * top)


ROWS: tuple[Row, ...] = (
    refusals(
        "refused-beams",
        "What no beam is",
        "beam.py, section.py, attached.py: every figure has its range, and what would do nothing is refused.",
        Case("beam.length = 0.0", beam(length=0.0), beam(length=1e-9)),
        Case("beam.width = -0.031", beam(width=-0.031)),
        Case("beam.thickness = nan", beam(thickness=float("nan"))),
        Case("beam.density = inf", beam(density=float("inf"))),
        Case("beam.youngs_modulus is missing", beam(youngs_modulus=None)),
        Case("beam.loss_factor = 10.0", beam(loss_factor=10.0), beam(loss_factor=9.99)),
        Case("beam.foundation = -1.0", beam(foundation=-1.0), beam(foundation=0.0)),
        Case("beam.supports has 'fixed'", beam(supports=("fixed", "free"))),
        Case("beam.supports = ('pinned',)", beam(supports=("pinned",))),
        Case("beam.shape = 'pipe'", beam(shape="pipe")),
        Case("beam.diameter = 0.01", beam(diameter=0.01)),
        Case("beam.section lengths add up to 0.7", beam(section=(Section(length=0.4), Section(length=0.3)))),
        Case("beam.mass[0].position = 0.7301", lambda: replace(STRIP, mass=(PointMass(position=0.7301, mass=0.02),))),
        Case("beam.mass[0].mass = 0.02", lambda: replace(STRIP, mass=(PointMass(position=0.73, mass=0.02),))),
        Case("beam.mass at position = 0.3", lambda: PointMass(position=0.3)),
        Case("beam.spring at position = 0.3", lambda: PointSpring(position=0.3)),
        Case("beam.spring.stiffness = -1.0", lambda: PointSpring(position=0.3, stiffness=-1.0)),
        Case("force.position = -1e-09", lambda: PointForce(position=-1e-9), lambda: PointForce(position=0.0)),
        Case("force.amplitude = nan", lambda: PointForce(position=0.3, amplitude=float("nan"))),
    ),
    refusals(
        "refused-modes",
        "Modes, sizes and settings that a model does not have",
        "docstrings of solve_modes, division.py, theory.py: unknown settings, more modes than there are, other beams.",
        *(
            Case("count: a motion of", modes(model, 3, of=hung(FREE, 1e-100)), modes(model, 3, of=hung(FREE, 1e-20)))
            for model in ("segment", "fem")
        ),
        Case(
            "the beam is held by",
            modes("segment", 3, 400, of=replace(FREE, foundation=1e-300)),
            modes("segment", 3, 400, of=replace(FREE, foundation=1e-20)),
        ),
        Case("count: a motion of", modes("fem", 1, of=hung(TURNS, 1e-36)), modes("fem", 1, of=hung(TURNS, 1e-25))),
        Case("n_modes = 9 is more than the 8", modes("segment", 9), modes("segment", 8)),
        Case("n_modes = 19 is more than the 18", modes("fem", 19), modes("fem", 18)),
        *(Case("n_modes = 0", modes(model, 0), modes(model, 1)) for model in ("segment", "fem")),
        Case("n_modes = 0", modes("analytic", 0, None), modes("analytic", 1, None)),
        Case("count = 1", modes("segment", 1, 1), modes("segment", 1, 2)),
        Case("count = 0", modes("fem", 1, 0), modes("fem", 1, 1)),
        Case("wall = 'welds'", modes("segment", 1, wall="welds")),
        Case("joints = 'serial'", modes("segment", 1, joints="serial")),
        Case("attachment = 'rigid'", modes("segment", 1, attachment="rigid")),
        *(Case("theory = 'shear'", modes(model, 1, theory="shear")) for model in ("segment", "fem")),
        Case("theory = 'shear'", modes("analytic", 1, None, theory="shear")),
        Case(
            "wall = 'welded'",
            modes("segment", 1, of=CANTILEVER, wall="welded", grading=1.5),
            modes("segment", 1, of=CANTILEVER, wall="welded"),
        ),
        Case("wall = 'welded'", modes("segment", 1, of=replace(CANTILEVER, tension=1.0), wall="welded")),
        Case("wall = 'welded'", modes("segment", 1, of=CANTILEVER, wall="welded", theory="rayleigh")),
        Case(
            "count = 5: joints = 'tensioned'",
            modes("segment", 1, 5, joints="tensioned", theory="timoshenko"),
            modes("segment", 1, 6, joints="tensioned", theory="timoshenko"),
        ),
        Case(
            "joints = 'tensioned': beam.tension",
            modes("segment", 1, 12, of=replace(STRIP, tension=2e5), joints="tensioned"),
            modes("segment", 1, 12, of=replace(STRIP, tension=2e3), joints="tensioned"),
        ),
        Case("grading = 1000.5", modes("segment", 1, grading=1000.5), modes("segment", 1, grading=1000.0)),
        Case("grading = 0.000999", modes("fem", 1, grading=0.000999), modes("fem", 1, grading=0.001)),
        Case("count = 2: a beam of 3 sections", modes("segment", 1, 2, THREE), modes("segment", 1, 3, THREE)),
        Case("count = 2: the beam's steps", modes("fem", 1, 2, LOADED), modes("fem", 1, 3, LOADED)),
        *(
            Case("beam.tension = 12.0 N with theory", modes(model, 1, of=TAUT, theory="rayleigh"), modes(model, 1))
            for model in ("segment", "fem")
        ),
        Case("beam.tension = 12.0 N with theory", modes("analytic", 1, None, TAUT, theory="timoshenko")),
        Case("beam.rotary_inertia is missing", modes("fem", 1, of=PLAIN, theory="rayleigh"), modes("fem", 1, of=PLAIN)),
        Case(
            "beam.shear_stiffness is missing",
            modes("fem", 1, of=TURNING, theory="timoshenko"),
            modes("fem", 1, of=TURNING, theory="rayleigh"),
        ),
        *(
            Case(
                "beam.supports = ['free', 'free']",
                lambda model=model, count=count: MODELS[model].time_basis(FREE, count, 5, "spline"),  # type: ignore[misc]
                lambda model=model, count=count: MODELS[model].time_basis(STRIP, count, 5, "spline"),  # type: ignore[misc]
            )
            for model, count in (("analytic", None), ("segment", PARTS), ("fem", PARTS))
        ),
        Case("modes = 5001", lambda: MODELS["analytic"].time_basis(STRIP, None, 5001, "spline")),
        Case("beam.tension: the exact beam", lambda: MODELS["analytic"].time_basis(TAUT, None, 5, "spline")),
        Case("line = 'curve'", lambda: MODELS["segment"].time_basis(STRIP, PARTS, 5, "curve")),
    ),
    refusals(
        "refused-drives",
        "Drives, dampings and readings that no field is made of",
        "docstrings of solve_harmonic, fields.py, places.py: forces and readings lie on the beam, dampings fit.",
        *(
            Case("force.position = 0.7301", field(model, at=0.7301), field(model, at=0.73))
            for model in ("analytic", "segment", "fem")
        ),
        *(Case("forces is empty", unforced(model)) for model in ("analytic", "segment", "fem")),
        Case("force.amplitude = 1e+102", field("analytic", newton=1e102), field("analytic", newton=1e90)),
        Case("frequency_hz = 0.0", field("analytic", hertz=0.0), field("analytic", hertz=1e-3)),
        Case("frequency_hz = -37.0", field("segment", hertz=-37.0)),
        Case("frequency_hz = nan", field("fem", hertz=float("nan"))),
        Case("load = 'levers'", field("segment", load="levers"), field("segment", load="lever")),
        Case("reading = 'curved'", field("segment", reading="curved"), field("segment", reading="raw")),
        *(
            Case("modal_damping = 1.0", field(model, modal_damping=1.0), field(model, modal_damping=0.99))
            for model in ("segment", "fem")
        ),
        *(Case("modal_damping = -1e-09", field(model, modal_damping=-1e-9)) for model in ("segment", "fem")),
        Case("joint_dashpot = -1e-09", field("segment", joint_dashpot=-1e-9), field("segment", joint_dashpot=0.0)),
        Case(
            "joint_dashpot and modal_damping together",
            field("segment", CANTILEVER, modal_damping=0.01, joint_dashpot=0.01),
        ),
        *(
            Case(
                "beam.loss_factor = 0.02 and modal_damping",
                field(model, replace(LOSSY, foundation=70.0), modal_damping=0.01),
                field(model, LOSSY, modal_damping=0.01),
            )
            for model in ("segment", "fem")
        ),
        Case("x = 0.7301", reading("segment", 0.7301), reading("segment", 0.73)),
        Case("x = -1e-09", reading("fem", -1e-9), reading("fem", 0.0)),
        Case("x = ['here']", reading("analytic", "here")),
        Case("frequencies_hz is empty", sweep("segment"), sweep("segment", 37.0)),
        Case("frequencies_hz[1] = -1.0", sweep("fem", 37.0, -1.0), sweep("fem", 37.0, 41.0)),
        Case("frequencies_hz[1] = nan", sweep("analytic", 37.0, float("nan"))),
        Case(
            "index = 2",
            lambda: (
                MODELS["segment"]
                .sweep_harmonic(STRIP, (PointForce(position=0.3),), np.array([37.0, 41.0]), PARTS)
                .field(2)
            ),
        ),
    ),
    refusals(
        "refused-laws",
        "Figures that have no law, bound or order",
        "exact/closed_forms.py, exact/error_laws.py, judge: a law is for its own beams, an order for errors above "
        "rounding.",
        Case("mode = 0", lambda: closed_forms.frequency_hz(STRIP, 0), lambda: closed_forms.frequency_hz(STRIP, 1)),
        Case("beam.section", lambda: closed_forms.frequency_hz(STEPPED, 1)),
        Case("beam.tension", lambda: closed_forms.frequency_hz(TAUT, 1)),
        Case(
            "theory = 'rayleigh' has a closed form",
            lambda: closed_forms.frequency_hz(CANTILEVER, 1, "rayleigh"),
            lambda: closed_forms.frequency_hz(STRIP, 1, "rayleigh"),
        ),
        Case("beam.rotary_inertia is missing", lambda: closed_forms.frequency_hz(PLAIN, 1, "rayleigh")),
        Case(
            "beam.shear_stiffness is missing",
            lambda: closed_forms.frequency_hz(TURNING, 1, "timoshenko"),
            lambda: closed_forms.frequency_hz(TURNING, 1, "rayleigh"),
        ),
        Case("frequency_hz = 0.0", lambda: closed_forms.quarter_wavelength(STRIP, 0.0)),
        Case(
            "beam.supports = ('clamped', 'free')",
            lambda: error_laws.dispersion_frequency_hz("segment", CANTILEVER, 1, PARTS),
        ),
        Case(
            "mode = 9: the dispersion of 9 parts",
            lambda: error_laws.dispersion_frequency_hz("segment", STRIP, 9, PARTS),
            lambda: error_laws.dispersion_frequency_hz("segment", STRIP, 8, PARTS),
        ),
        *(Case("count = 9: 9 ", carried(model, 1.0001), carried(model, 0.9999)) for model in ("segment", "fem")),
        Case(
            "error = 9e-13",
            lambda: error_laws.parts_from_here_on("segment", STRIP, 1, 9e-13),
            lambda: error_laws.parts_from_here_on("segment", STRIP, 1, 1e-12),
        ),
        Case("model = 'analytic': no error law", lambda: error_laws.law_of("analytic")),
        Case("counts = [10, 20]", order((10, 20), 0.1, 0.02), order((10, 20, 40), 0.1, 0.02, 0.006)),
        Case("counts = [10, 20, 20]", order((10, 20, 20), 0.1, 0.02, 0.02)),
        Case("counts = [10, 20, 40]: the error changes sign", order((10, 20, 40), 0.1, -0.02, 0.006)),
        Case("counts = [10, 20, 40]: an error that is not finite", order((10, 20, 40), 0.1, 0.02, float("inf"))),
        Case(
            "counts = [10, 20, 40]: an error of",
            order((10, 20, 40), 0.1, 0.02, 0.9 * compare.ORDER_FLOOR),
            order((10, 20, 40), 0.1, 0.02, 1.1 * compare.ORDER_FLOOR),
        ),
        Case("bracket from 1.0", lambda: compare.bracket(1.0, 1.0 + 1e-13), lambda: compare.bracket(1.0, 1.0 + 1e-12)),
        Case("bracket from 1.0 to inf", lambda: compare.bracket(1.0, float("inf"))),
        Case("the exact figure is zero", lambda: compare.check_reference(0.0), lambda: compare.check_reference(-1.0)),
        Case("the exact figure is infinite", lambda: compare.check_reference(float("inf"))),
        Case("count: the exact shape", lambda: compare.shape_error(np.zeros(3), np.ones(3), np.ones(3))),
        Case("mode.bracket: with wall", bracket(CANTILEVER), bracket(CANTILEVER, settings=(("wall", "half"),))),
        Case("mode.bracket: on a beam with beam.tension", bracket(TAUT), bracket(STRIP)),
        Case("mode.bracket: on a stepped beam", bracket(STEPPED)),
        Case("mode.bracket: with theory", bracket(STRIP, settings=(("theory", "rayleigh"),))),
        Case("mode.bracket: with grading", bracket(STRIP, settings=(("grading", 2.0),))),
        Case("mode.bracket: at count = 40000", bracket(STRIP, 40_000)),
        Case(
            "mode = 9: the segment model at count = 9 has 8",
            lambda: Workbench(STRIP).frequency_hz("segment", PARTS, 9),
            lambda: Workbench(STRIP).frequency_hz("segment", PARTS, 8),
        ),
        Case(
            "reading = 'curved'",
            lambda: Workbench(STRIP).shape_error("segment", PARTS, 2, "curved"),
            lambda: Workbench(STRIP).shape_error("segment", PARTS, 2, "raw"),
        ),
        Case("count = 5", lambda: chain_bands(("clamped", "free"), 5), lambda: chain_bands(("clamped", "free"), 6)),
    ),
)
