"""Checks of modes: size, scale, uneven parts, attachments, foundation, axial force.

1e-12 is what rounding costs a frequency of many parts, 1e-14 and less what a closed form leaves.
"""

import dataclasses
from collections.abc import Callable
from math import cos, cosh, pi, sin, sinh, sqrt
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.analytic_modes import ExactModel
from verify.linear.registry import MODELS
from verify.problem.beam import Beam, PointForce
from verify.problem.cross_section import Section
from verify.problem.point_attachments import PointMass, PointSpring
from verify.stress import reference
from verify.stress.engine import check, worst
from verify.stress.reference import CANTILEVER, FREE, MATRICES, PI, STRIP, D, Parts, equal, relative_error, sparse

N = 40
DISCRETE = {"segment": "segments", "fem": "elements"}
ALL = ("analytic", *DISCRETE)
DECADES = (1e-12, 1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9, 1e12)
FAR = (1e15, 1e18, 1e24)
E, RHO = 113e9, 4470.0


def frequency(model: str, beam: Beam, mode: int, n: int = N, **settings: float) -> float:
    """Hz, of one mode of a model."""
    if model == "analytic":
        return ExactModel(beam).frequency_hz(mode)
    return float(MODELS[model].build(beam, n, **settings).modes(mode).frequencies_hz[mode - 1])


def own_error(model: str, beam: Beam, parts: Parts, mode: int, **settings: float) -> float:
    """Relative error of a model's frequency against its own matrices in 60 digits."""
    hertz = frequency(model, beam, mode, len(parts.lengths), **settings)
    return relative_error(*MATRICES[model](parts), mode, 2 * PI * D(hertz))


def lapack(parts: Callable[[float], Parts], mode: int) -> tuple[Any, ...]:
    """The baseline scipy.linalg.eigh on assembled matrices."""

    def error(model: str, value: float) -> float:
        from scipy.linalg import eigh

        bands = MATRICES[model](parts(value))
        values = eigh(*(sparse(one).toarray() for one in bands), eigvals_only=True)
        return relative_error(*bands, mode, sqrt(abs(values[mode - 1])))

    return "LAPACK on assembled K and M", error


def dispersion(model: str, n: float, modes: int) -> Any:
    """Hz, of the first modes of the pinned strip in equal parts, in closed form."""
    from verify.exact.error_laws import dispersion_frequency_hz

    return np.array([dispersion_frequency_hz(model, STRIP, mode, int(n)) for mode in range(1, modes + 1)])


def eigsh_error(model: str, n: float) -> float:
    """Of scipy's eigsh about 0 on assembled matrices of equal unit parts."""
    from scipy.sparse.linalg import eigsh

    one = [D(1)] * int(n)
    k, m = map(sparse, MATRICES[model](Parts(STRIP.supports, one, one, one)))
    start = np.random.default_rng(1).standard_normal(k.shape[0])
    squares = np.sort(eigsh(k, k=5, M=m, sigma=0, v0=start, return_eigenvectors=False))
    hertz = np.sqrt(abs(squares)) * STRIP.wave_constant * (n / STRIP.length) ** 2 / (2.0 * pi)
    return worst(hertz / dispersion(model, n, 5) - 1.0)


EIGSH = "eigsh on assembled K and M"


@check("size", "N", (100, 1000, 10_000, 30_000), 1e-12, models=DISCRETE, baseline=(EIGSH, eigsh_error))
def size(model: str, n: float) -> float:
    """Modes 1-5 of a pinned strip against the discrete dispersion."""
    return worst(MODELS[model].build(STRIP, int(n)).modes(5).frequencies_hz / dispersion(model, n, 5) - 1.0)


_MORE = (EIGSH, eigsh_error, (1e4, 3e4, 5e4))
check("size-million", "N", (1e5, 3e5, 1e6), 1e-12, models=DISCRETE, baseline=_MORE, slow=True)(size)


@check("cantilever", "N", (60, 400), 1e-12, models=DISCRETE, baseline=lapack(lambda n: equal(CANTILEVER, int(n)), 1))
def cantilever(model: str, n: float) -> float:
    """Mode 1 of a cantilever against eigenvalue counts."""
    return own_error(model, CANTILEVER, equal(CANTILEVER, int(n)), 1)


def newton_error(mode: float) -> float:
    """Of cos y cosh y = -1 as printed."""
    y = (mode - 0.5) * pi
    for _ in range(20):
        y -= (cos(y) * cosh(y) + 1.0) / (cos(y) * sinh(y) - sin(y) * cosh(y))
    return 2.0 * abs(float(D(y) / reference.cantilever_root(int(mode)) - 1))


_NEWTON = ("Newton on cos y cosh y = -1", newton_error, (1, 10, 100, 300))
_MODES = (1, 2, 3, 10, 100, 1000, 10_000, 100_000)


@check("exact-frequency", "mode", _MODES, 6e-16, beyond=(1e7, 1e9, 1e12), baseline=_NEWTON)
def exact_frequency(mode: float) -> float:
    """Exact cantilever frequency against cos y cosh y = -1."""
    from verify.exact.closed_forms import frequency_hz

    y = reference.cantilever_root(int(mode))
    exact = (y / D(CANTILEVER.length)) ** 2 * D(CANTILEVER.wave_constant) / (2 * PI)
    return abs(float(D(frequency_hz(CANTILEVER, int(mode))) / exact - 1))


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
    """Of the shape as printed."""
    y, x = float(reference.cantilever_root(int(mode))), np.array(PLACES)
    sigma = (sinh(y) - sin(y)) / (cosh(y) + cos(y))
    found = np.cosh(y * x) - np.cos(y * x) - sigma * (np.sinh(y * x) - np.sin(y * x))
    return worst(found - [shape_value(mode, place) for place in PLACES]) / 2.0


_PRINTED = ("cosh - cos - sigma (sinh - sin)", printed_shape_error, (1, 5, 10, 15, 300))


@check("exact-shape", "mode", (1, 2, 5, 50, 1000, 100_000), 4e-16, baseline=_PRINTED)
def exact_shape(mode: float) -> float:
    """Exact cantilever shape of amplitude 2 at four places, over the amplitude and the radians of its waves."""
    beam = replace(CANTILEVER, length=1.0)
    found = ExactModel(beam).mode_shape(int(mode), np.array(PLACES)) * np.sqrt(beam.mass_per_length)
    return worst(found - [shape_value(mode, place) for place in PLACES]) / (2.0 * max(mode, 1.0) * pi)


def pinned_hertz(beam: Beam, mode: int) -> D:
    """((EI beta^2 + T) beta^2 + k) / (rho A) = omega^2, beta = n pi / L."""
    square = (mode * PI / D(beam.length)) ** 2
    stiffness = (D(beam.bending_stiffness) * square + D(beam.tension)) * square + D(beam.foundation)
    return (stiffness / D(beam.mass_per_length)).sqrt() / (2 * PI)


def pinned_error(beam: Beam, mode: float) -> float:
    """Of the exact model between pins."""
    return abs(float(D(frequency("analytic", beam, int(mode))) / pinned_hertz(beam, int(mode)) - 1))


@check("exact-foundation-tension", "mode", (1, 10, 100, 1000, 10_000, 100_000), 1e-14)
def exact_foundation_tension(mode: float) -> float:
    """Exact pinned beam on a foundation, slack and taut."""
    beams = replace(STRIP, foundation=1234.5), replace(STRIP, tension=1e7, foundation=1e11)
    return worst([pinned_error(beam, mode) for beam in beams])


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
    return worst(
        [scale_error(replace(STRIP, youngs_modulus=ratio * E)), scale_error(replace(STRIP, density=ratio * RHO))]
    )


def sections(share: float, counts: tuple[int, int], ei: float, ra: float) -> tuple[Beam, Parts]:
    """A strip whose first section has other EI and rho A, as ratios, and its parts."""
    first = Section(length=share * STRIP.length, density=ra * RHO, youngs_modulus=ei * E)
    beam = replace(STRIP, section=(first, Section(length=STRIP.length - first.length)))
    lengths = D(first.length) / counts[0], (D(STRIP.length) - D(first.length)) / counts[1]
    ei_values = D(STRIP.bending_stiffness) * D(ei), D(STRIP.bending_stiffness)
    ra_values = D(STRIP.mass_per_length) * D(ra), D(STRIP.mass_per_length)
    rows = [[a] * counts[0] + [b] * counts[1] for a, b in (lengths, ei_values, ra_values)]
    return beam, Parts(STRIP.supports, rows[0], rows[1], rows[2])


def stepped(ratio: float) -> tuple[Beam, Parts]:
    """0.3 of the strip with another modulus, 40 parts."""
    return sections(0.3, (12, 28), ratio, 1.0)


def short(share: float) -> tuple[Beam, Parts]:
    """One short, soft and heavier part in front of three."""
    return sections(share, (1, 3), 1e-5, 1.1)


def graded(ratio: float, n: int = 120) -> Parts:
    """Lengths in geometric progression, the last `ratio` times the first."""
    steps = [D(ratio) ** (D(i) / (n - 1)) for i in range(n)]
    return dataclasses.replace(equal(STRIP, n), lengths=[D(STRIP.length) * one / sum(steps) for one in steps])


_STEP: dict[str, Any] = {
    "models": DISCRETE,
    "beyond": (1e9, 1e12, 1e14, 1e16),
    "baseline": lapack(lambda ratio: stepped(ratio)[1], 3),
}
_GRADED: dict[str, Any] = {"models": DISCRETE, "beyond": (1001, 1e6), "refused": True, "baseline": lapack(graded, 3)}
_SHORT: dict[str, Any] = {
    "models": DISCRETE,
    "beyond": (9e-7, 1e-12),
    "refused": True,
    "baseline": lapack(lambda a: short(a)[1], 2),
}


@check("stiffness-step", "E1 / E2", (1, 10, 1e3, 1e6), 1e-12, **_STEP)
def stiffness_step(model: str, ratio: float) -> float:
    """Mode 3 of a stepped strip."""
    return own_error(model, *stepped(ratio), 3)


@check("graded-mesh", "last / first length", (1, 10, 1e3), 1e-12, **_GRADED)
def graded_mesh(model: str, ratio: float) -> float:
    """Mode 3 of 120 graded parts."""
    return own_error(model, STRIP, graded(ratio), 3, grading=ratio)


@check("short-part", "first length / L", (0.1, 1e-2, 1e-3, 1e-4, 1e-6), 1e-12, **_SHORT)
def short_part(model: str, share: float) -> float:
    """Mode 2 of four parts, the first one short and soft."""
    return own_error(model, *short(share), 2)


def with_tip(kind: str, ratio: float) -> tuple[Beam, Parts]:
    """A cantilever with a tip mass over rho A L or a tip spring over EI / L^3."""
    x = CANTILEVER.length
    if kind == "mass":
        value = ratio * CANTILEVER.mass_per_length * x
        return replace(CANTILEVER, mass=(PointMass(position=x, mass=value),)), equal(CANTILEVER, N, masses={N: value})
    value = ratio * CANTILEVER.bending_stiffness / x**3
    beam = replace(CANTILEVER, spring=(PointSpring(position=x, stiffness=value),))
    return beam, equal(CANTILEVER, N, springs={N: value})


for _id, _kind, _mode, _unit, _beyond in (
    ("tip-mass", "mass", 1, "m / (rho A L)", FAR),
    ("tip-mass-mode-2", "mass", 2, "m / (rho A L)", ()),
    ("tip-spring", "spring", 2, "k L^3 / EI", FAR),
):
    _more = {"baseline": lapack(lambda ratio, kind=_kind: with_tip(kind, ratio)[1], _mode), "beyond": _beyond}  # type: ignore[misc]
    _title = f"Mode {_mode} of a cantilever of elements with a tip {_kind}"

    @check(_id, _unit, DECADES, 1e-12, models={"fem": ""}, title=_title, **_more)
    def tip(model: str, ratio: float, kind: str = _kind, mode: int = _mode) -> float:
        """Against the model's own matrices."""
        return own_error(model, *with_tip(kind, ratio), mode)


@check("foundation", "k L^4 / EI", DECADES, 1e-12, beyond=FAR)
def foundation(ratio: float) -> float:
    """Mode 2 of pinned beams, three models: omega^2 grows by k / (rho A)."""
    beam = replace(STRIP, foundation=ratio * STRIP.bending_stiffness / STRIP.length**4)
    bare = {m: D(float(dispersion(m, N, 2)[1])) for m in DISCRETE} | {"analytic": pinned_hertz(STRIP, 2)}
    added = D(beam.foundation) / D(beam.mass_per_length)
    exact = {m: ((2 * PI * hertz) ** 2 + added).sqrt() / (2 * PI) for m, hertz in bare.items()}
    return worst([float(D(frequency(m, beam, 2)) / exact[m] - 1) for m in exact])


@check("nearly-free", "EI / (k L^4)", (1e-8, 1e-3, 1e3, 1e6), 1e-12, beyond=(1e9, 1e12, 1e15))
def nearly_free(softness: float) -> float:
    """Modes 1-3 of free bars of 49 and 2000 parts on a foundation, two models."""
    beam = replace(FREE, foundation=FREE.bending_stiffness / FREE.length**4 / softness)
    errors = [own_error(model, beam, equal(beam, 49), mode) for model in DISCRETE for mode in (1, 3)]
    own, added = D(beam.wave_constant), D(beam.foundation) / D(beam.mass_per_length)
    roots = D(0), D(0), D("4.7300407448627040260240481")  # cos y cosh y = 1
    exact = [(((y / D(beam.length)) ** 2 * own) ** 2 + added).sqrt() / (2 * PI) for y in roots]
    found = [MODELS[model].build(beam, 2000).modes(3).frequencies_hz.tolist() for model in DISCRETE]
    return worst(errors, [float(D(f) / e - 1) for each in found for f, e in zip(each, exact, strict=True)])


@check("nearly-floating", "EI / (k L^3)", (10.0, 1e4), 5e-9, beyond=(1e6, 1e10, 1e14))
def nearly_floating(softness: float) -> float:
    """Tip deflection of bars of 49 and 2100 parts about a pin on one or two springs, driven slowly, two models."""
    beam = replace(STRIP, supports=("pinned", "free"))
    stiffness = beam.bending_stiffness / beam.length**3 / softness
    hertz = 0.6 * sqrt(beam.bending_stiffness / softness / beam.mass_per_length) / beam.length**2 / (2.0 * pi)
    errors = []
    for model, (n, sevenths) in ((m, case) for m in DISCRETE for case in ((49, (5,)), (2100, (5,)), (49, (3, 5)))):
        per_node = 1 if model == "segment" else 2
        parts = equal(beam, n, springs={s * n // 7: stiffness for s in sevenths})
        force, tip = per_node * 2 * n // 7 - 1, per_node * n - 1  # the pin has no deflection
        exact = reference.response(*MATRICES[model](parts), 2 * PI * D(hertz), force)[tip]
        springs = tuple(PointSpring(position=s / 7.0 * beam.length, stiffness=stiffness) for s in sevenths)
        lever = {"load": "lever", "attachment": "lever", "reading": "raw"} if model == "segment" else {}
        drive = (PointForce(position=2 * n // 7 * beam.length / n),)
        field = MODELS[model].build(replace(beam, spring=springs), n, **lever).harmonic(drive, hertz)
        errors.append(float(D(float(field.deflection(beam.length)[0].real)) / exact - 1))
    return worst(errors)


@check("tension", "T L^2 / EI", DECADES, 1e-12, beyond=(1e15, 1e20, 1e30))
def tension(ratio: float) -> float:
    """Exact mode 3 from a beam to a string."""
    return pinned_error(replace(STRIP, tension=ratio * STRIP.bending_stiffness / STRIP.length**2), 3)


def buckling(model: str, beam: Beam, n: int = N) -> float:
    """Newton."""
    return float(MODELS[model].build(beam, None if model == "analytic" else n).buckling_load())


@check("near-buckling", "1 - P / Pcr", (1, 1e-3, 1e-6, 1e-9), 1e-13, beyond=(1e-11, 1e-13, 1e-17))
def near_buckling(left: float) -> float:
    """Mode 1 close to buckling, three models: error times the share of the load that is left."""
    errors = []
    for model in ALL:
        beam = replace(STRIP, tension=-(1.0 - left) * buckling(model, STRIP))
        errors.append(pinned_error(beam, 1) if model == "analytic" else own_error(model, beam, equal(beam, N), 1))
    return left * worst(errors)


@check("buckling-soft-ground", "EI / (k L^4)", (1e6, 1e9, 1e12, 1e15), 1e-12)
def buckling_soft_ground(softness: float) -> float:
    """Load at which free bars of 49 and 2000 parts on soft ground tip over, three models."""
    beam = replace(FREE, foundation=FREE.bending_stiffness / FREE.length**4 / softness)
    exact = buckling("analytic", beam)
    # the bar turns as a whole under k L^2 / 12, of which bending under k x takes the 2520th part of k L^4 / EI
    tipping = beam.foundation * beam.length**2 / 12.0 * (1.0 - 1.0 / (2520.0 * softness))
    found = [buckling(model, beam, n) for model in DISCRETE for n in (49, 2000)]
    return worst(np.array(found) / exact - 1.0, exact / tipping - 1.0)
