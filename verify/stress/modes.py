"""Checks of modes: size, scale, uneven parts, attachments, foundation, axial force.

Tolerances: 1e-12 for rounding with many parts, 1e-14 and less for closed forms.
"""

from collections.abc import Callable, Mapping, Sequence
from math import cos, cosh, pi, sin, sinh, sqrt
from typing import Any

import numpy as np
from msgspec.structs import replace
from scipy.linalg import eigh
from scipy.sparse.linalg import eigsh

from verify.analytic_modes import ExactModel
from verify.exact.error_laws import dispersion_frequency_hz
from verify.linear.registry import MODELS
from verify.problem.beam import Beam, PointForce
from verify.problem.cross_section import Section
from verify.problem.point_attachments import PointMass, PointSpring
from verify.stress import reference
from verify.stress.engine import check, worst
from verify.stress.reference import ALL, CANTILEVER, DISCRETE, FREE, MATRICES, PI, STRIP, D, equal, relative_error

N = 40
E, RHO = STRIP.youngs_modulus or 0.0, STRIP.density or 0.0
DECADES = (1e-12, 1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9, 1e12)
FAR = (1e15, 1e18, 1e24)


def frequency(model: str, beam: Beam, mode: int, n: int = N, **settings: float) -> float:
    """Frequency of a mode of a model, Hz."""
    if model == "analytic":
        return ExactModel(beam).frequency_hz(mode)
    return float(MODELS[model].build(beam, n, **settings).modes(mode).frequencies_hz[mode - 1])


def own_error(model: str, beam: Beam, lengths: Sequence[D], mode: int, **settings: float) -> float:
    """Relative error of a model's frequency against its own matrices in 60 digits."""
    hertz = frequency(model, beam, mode, len(lengths), **settings)
    return relative_error(*MATRICES[model](beam, lengths), mode, 2 * PI * D(hertz))


def dispersion(model: str, n: float, modes: int) -> Any:
    """Frequencies of the first modes of the pinned strip in equal parts, Hz, in closed form."""
    return np.array([dispersion_frequency_hz(model, STRIP, mode, int(n)) for mode in range(1, modes + 1)])


def eigsh_error(model: str, n: float) -> float:
    """Error of scipy's eigsh about 0 with assembled matrices of unit parts."""
    unit = Beam(length=n, bending_stiffness=1.0, mass_per_length=1.0)
    k, m = reference.sparse(*MATRICES[model](unit, [D(1)] * int(n)))
    start = np.random.default_rng(1).standard_normal(k.shape[0])
    squares = np.sort(eigsh(k, k=5, M=m, sigma=0, v0=start, return_eigenvectors=False))
    hertz = np.sqrt(abs(squares)) * STRIP.wave_constant * (n / STRIP.length) ** 2 / (2.0 * pi)
    return worst(hertz / dispersion(model, n, 5) - 1.0)


EIGSH = "eigsh on assembled K and M", eigsh_error


@check("size", "N", (100, 1000, 10_000, 30_000), 1e-12, DISCRETE, baseline=EIGSH)
def size(model: str, n: float) -> float:
    """Modes 1-5 of a pinned strip against the discrete dispersion."""
    return worst(MODELS[model].build(STRIP, int(n)).modes(5).frequencies_hz / dispersion(model, n, 5) - 1.0)


check("size-million", "N", (1e5, 3e5, 1e6), 1e-12, DISCRETE, baseline=(*EIGSH, (1e4, 3e4, 5e4)), slow=True)(size)


def newton_error(mode: float) -> float:
    """Error of Newton's method for cos y cosh y = -1 in its usual form."""
    y = (mode - 0.5) * pi
    for _ in range(20):
        y -= (cos(y) * cosh(y) + 1.0) / (cos(y) * sinh(y) - sin(y) * cosh(y))
    return 2.0 * abs(float(D(y) / reference.cantilever_root(int(mode)) - 1))


_NEWTON = ("Newton on cos y cosh y = -1", newton_error, (1, 10, 100, 300))
_MODES = (1, 2, 3, 10, 100, 1000, 10_000, 100_000)


@check("exact-frequency", "mode", _MODES, 6e-16, beyond=(1e7, 1e9, 1e12), baseline=_NEWTON)
def exact_frequency(mode: float) -> float:
    """Exact cantilever frequency against cos y cosh y = -1."""
    y = reference.cantilever_root(int(mode))
    exact = (y / D(CANTILEVER.length)) ** 2 * D(CANTILEVER.wave_constant) / (2 * PI)
    return abs(float(D(frequency("analytic", CANTILEVER, int(mode))) / exact - 1))


PLACES = (0.031, 0.37, 0.61, 0.93)


def shape_value(mode: float, x: float) -> float:
    """Cosh - cos - sigma (sinh - sin) of a cantilever at x / L, the growing exponentials combined."""
    y, z = reference.cantilever_root(int(mode)), D(x)
    fall = (-y).exp()
    rise = (fall + reference.cos(y) + reference.sin(y)) / (1 + fall * fall + 2 * fall * reference.cos(y))
    sigma = 1 - 2 * fall * rise
    waves = sigma * reference.sin(y * z) - reference.cos(y * z)
    return float(rise * (-y * (1 - z)).exp() + (1 + sigma) / 2 * (-y * z).exp() + waves)


def printed_shape_error(mode: float) -> float:
    """Error of the cantilever shape in its usual form."""
    y, x = float(reference.cantilever_root(int(mode))), np.array(PLACES)
    sigma = (sinh(y) - sin(y)) / (cosh(y) + cos(y))
    printed = np.cosh(y * x) - np.cos(y * x) - sigma * (np.sinh(y * x) - np.sin(y * x))
    return worst(printed - [shape_value(mode, place) for place in PLACES]) / 2.0


_PRINTED = ("cosh - cos - sigma (sinh - sin)", printed_shape_error, (1, 5, 10, 15, 300))


@check("exact-shape", "mode", (1, 2, 5, 50, 1000, 100_000), 4e-16, baseline=_PRINTED)
def exact_shape(mode: float) -> float:
    """Exact cantilever shape of amplitude 2 at four places, over the amplitude and the radians of its waves."""
    beam = replace(CANTILEVER, length=1.0)
    shape = ExactModel(beam).mode_shape(int(mode), np.array(PLACES)) * np.sqrt(beam.mass_per_length)
    return worst(shape - [shape_value(mode, place) for place in PLACES]) / (2.0 * max(mode, 1.0) * pi)


def pinned_error(beam: Beam, mode: float) -> float:
    """Frequency error of the exact model with pinned ends."""
    return abs(float(D(frequency("analytic", beam, int(mode))) / reference.pinned_hertz(beam, int(mode)) - 1))


@check("exact-foundation-tension", "mode", (1, 10, 100, 1000, 10_000, 100_000), 1e-14)
def exact_foundation_tension(mode: float) -> float:
    """Exact pinned beam on a foundation, slack and taut."""
    beams = replace(STRIP, foundation=1234.5), replace(STRIP, tension=1e7, foundation=1e11)
    return worst([pinned_error(beam, mode) for beam in beams])


@check("tension", "T L^2 / EI", DECADES, 1e-12, beyond=(1e15, 1e20, 1e30))
def tension(ratio: float) -> float:
    """Exact mode 3 from a beam to a string."""
    return pinned_error(replace(STRIP, tension=ratio * STRIP.bending_stiffness / STRIP.length**2), 3)


def scale_error(beam: Beam) -> float:
    """Relative change of the dimensionless frequency of mode 3, three models."""
    unit = (beam.length / STRIP.length) ** 2 * STRIP.wave_constant / beam.wave_constant
    return worst([frequency(model, beam, 3) / frequency(model, STRIP, 3) * unit - 1.0 for model in ALL])


@check("length-scale", "L, m", (1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6), 1e-14, beyond=(1e12, 1e24, 1e30), refused=True)
def length_scale(length: float) -> float:
    """Dimensionless frequency at every size, three models."""
    ratio = length / STRIP.length
    return scale_error(replace(STRIP, length=length, width=0.031 * ratio, thickness=0.0023 * ratio))


@check("material-scale", "E, rho over titanium", DECADES, 1e-14, beyond=(1e30, 1e60, 1e100), refused=True)
def material_scale(ratio: float) -> float:
    """Dimensionless frequency over modulus and over density, three models."""
    beams = replace(STRIP, youngs_modulus=ratio * E), replace(STRIP, density=ratio * RHO)
    return worst(list(map(scale_error, beams)))


def matrix_check(
    id: str, parameter: str, values: Sequence[float], mode: int, models: Mapping[str, str] = DISCRETE, **more: Any
) -> Callable[[Callable[[float], Any]], Any]:
    """Register a mode of `case(value)` = (beam, lengths of parts, grading if any) against its matrices in 60 digits."""

    def register(case: Callable[[float], Any]) -> Callable[[float], Any]:
        def error(model: str, value: float) -> float:
            beam, lengths, grading = (*case(value), 1.0)[:3]
            return own_error(model, beam, lengths, mode, grading=grading)

        def lapack(model: str, value: float) -> float:
            bands = MATRICES[model](*case(value)[:2])
            squares = eigh(*(one.toarray() for one in reference.sparse(*bands)), eigvals_only=True)
            return relative_error(*bands, mode, sqrt(abs(squares[mode - 1])))

        title, baseline = (case.__doc__ or "").rstrip("."), ("LAPACK on assembled K and M", lapack)
        check(id, parameter, values, 1e-12, models, baseline=baseline, **{"title": title, **more})(error)
        return case

    return register


@matrix_check("cantilever", "N", (60, 400), 1)
def cantilever(n: float) -> Any:
    """Mode 1 of a cantilever against eigenvalue counts."""
    return CANTILEVER, equal(CANTILEVER, int(n))


def sections(counts: tuple[int, int], share: float, **first: Any) -> tuple[Beam, list[D]]:
    """A strip with another first section, each of the two in equal parts."""
    both = Section(length=share * STRIP.length, **first), Section(length=STRIP.length - share * STRIP.length)
    lengths = [D(one.length) / n for one, n in zip(both, counts, strict=True) for _ in range(n)]
    return replace(STRIP, section=both), lengths


@matrix_check("stiffness-step", "E1 / E2", (1, 10, 1e3, 1e6), 3, beyond=(1e9, 1e12, 1e14, 1e16))
def stiffness_step(ratio: float) -> Any:
    """Mode 3 of a stepped strip."""
    return sections((12, 28), 0.3, youngs_modulus=ratio * E)


@matrix_check("graded-mesh", "last / first length", (1, 10, 1e3), 3, beyond=(1001, 1e6), refused=True)
def graded_mesh(ratio: float) -> Any:
    """Mode 3 of 120 graded parts."""
    steps = [D(ratio) ** (D(i) / 119) for i in range(120)]
    return STRIP, [D(STRIP.length) * one / sum(steps) for one in steps], ratio


@matrix_check("short-part", "first length / L", (0.1, 1e-2, 1e-3, 1e-4, 1e-6), 2, beyond=(9e-7, 1e-12), refused=True)
def short_part(share: float) -> Any:
    """Mode 2 of four parts, the first one short and soft."""
    return sections((1, 3), share, youngs_modulus=1e-5 * E, density=1.1 * RHO)


@matrix_check("tip-mass", "m / (rho A L)", DECADES, 1, {"fem": ""}, beyond=FAR)
def tip_mass(ratio: float) -> Any:
    """Mode 1 of a cantilever of elements with a tip mass."""
    length = CANTILEVER.length
    mass = PointMass(position=length, mass=ratio * CANTILEVER.mass_per_length * length)
    return replace(CANTILEVER, mass=(mass,)), equal(CANTILEVER, N)


@check("nearly-free", "EI / (k L^4)", (1e-8, 1e-3, 1e3, 1e6), 1e-12, beyond=(1e9, 1e12, 1e15))
def nearly_free(softness: float) -> float:
    """Modes 1-3 of free bars of 49 and 2000 parts on a foundation, two models."""
    beam = replace(FREE, foundation=FREE.bending_stiffness / FREE.length**4 / softness)
    errors = [own_error(model, beam, equal(beam, 49), mode) for model in DISCRETE for mode in (1, 3)]
    own, added = D(beam.wave_constant), D(beam.foundation) / D(beam.mass_per_length)
    roots = D(0), D(0), D("4.7300407448627040260240481")  # cos y cosh y = 1
    exact = [(((y / D(beam.length)) ** 2 * own) ** 2 + added).sqrt() / (2 * PI) for y in roots]
    fine = [MODELS[model].build(beam, 2000).modes(3).frequencies_hz.tolist() for model in DISCRETE]
    return worst(errors, [float(D(f) / e - 1) for each in fine for f, e in zip(each, exact, strict=True)])


@check("nearly-floating", "EI / (k L^3)", (10.0, 1e4), 5e-9, beyond=(1e6, 1e10, 1e14))
def nearly_floating(softness: float) -> float:
    """Tip deflection of bars of 49 and 2100 parts about a pin on one or two springs, driven slowly, two models."""
    bar, length = replace(STRIP, supports=("pinned", "free")), STRIP.length
    stiffness = bar.bending_stiffness / length**3 / softness
    hertz = 0.6 * sqrt(bar.bending_stiffness / softness / bar.mass_per_length) / length**2 / (2.0 * pi)
    errors = []
    for model, (n, sevenths) in ((m, case) for m in DISCRETE for case in ((49, (5,)), (2100, (5,)), (49, (3, 5)))):
        springs = tuple(PointSpring(position=s / 7.0 * length, stiffness=stiffness) for s in sevenths)
        beam, per_node = replace(bar, spring=springs), 1 if model == "segment" else 2
        v = reference.response(*MATRICES[model](beam, equal(beam, n)), 2 * PI * D(hertz), per_node * 2 * n // 7)
        lever = {"load": "lever", "attachment": "lever", "reading": "raw"} if model == "segment" else {}
        drive = (PointForce(position=2 * n // 7 * length / n),)
        field = MODELS[model].build(beam, n, **lever).harmonic(drive, hertz)
        errors.append(float(D(float(field.deflection(length)[0].real)) / v[per_node * n] - 1))
    return worst(errors)


@check("near-buckling", "1 - P / Pcr", (1, 1e-3, 1e-6, 1e-9), 1e-13, beyond=(1e-11, 1e-13, 1e-17))
def near_buckling(left: float) -> float:
    """Mode 1 close to buckling, three models: error times 1 - P / Pcr."""
    errors = []
    for model in ALL:
        load = MODELS[model].build(STRIP, None if model == "analytic" else N).buckling_load()
        beam = replace(STRIP, tension=-(1.0 - left) * float(load))
        errors.append(pinned_error(beam, 1) if model == "analytic" else own_error(model, beam, equal(beam, N), 1))
    return left * worst(errors)
