"""What gates expect that no other reference here has: laws in closed form, and chains and elements written out.

Closed forms of the paper's beam, of its waves and of friction; matrices in 40 digits where an error of 1e-9 is the
figure; polygons, power series and least energy for the chain. Nothing of the suite but what a scene holds.
"""

import math
from functools import cache

import mpmath as mp
import numpy as np
from books_reference import ridden
from carried_reference import GREGORY, enough_links
from chain_reference import elastica_tip, woinowsky_krieger
from driven_reference import Elements, Links, phasor, unit_field
from scipy.interpolate import CubicSpline
from scipy.linalg import eigh
from scipy.optimize import brentq
from scipy.special import jn_zeros
from states_reference import frequency_near

from verify.scenes.scene import load_scene

GRAVITY = 9.81
FIVE = np.array([95 / 288, 317 / 240, 23 / 30, 793 / 720, 157 / 160])

# --- Pinned beams, their chains and their elements ----------------------------------------------------------------------


class Paper:
    """The paper's beam, EI in N m^2, mass in kg/m."""

    L, H, EI, LINE = 0.5, 1e-3, 70e9 * 0.02 * 1e-9 / 12, 2700 * 0.02 * 1e-3
    C = (EI / LINE) ** 0.5
    D, W = 0.0116, 2 * np.pi * 4276.0
    K = (W / C) ** 0.5


def pinned_hertz(n):
    return (n * np.pi / Paper.L) ** 2 * Paper.C / (2 * np.pi)


def chain_ratio(mu):
    """Frequency of a chain's sine over the beam's, turn mu from joint to joint."""
    s2 = np.sin(mu / 2) ** 2
    return 4 * s2 / mu**2 / np.sqrt(1 - 2 * s2 / 3)


def hermite_ratio(mu):
    """The same of equal Hermite elements: the lower root of the two equations of a node."""
    c = np.cos(mu)
    k = np.array([[24 - 24 * c, 12 * np.sin(mu)], [12 * np.sin(mu), 8 + 4 * c]])
    m = np.array([[312 + 108 * c, -26 * np.sin(mu)], [-26 * np.sin(mu), 8 - 6 * c]]) / 420
    return np.sqrt(eigh(k, m, eigvals_only=True)[0]) / mu**2


def hermite_norm(mu):
    """Largest deflection of a mode of mass 1 over the exact one's."""
    c = np.cos(mu)
    k = np.array([[24 - 24 * c, 12 * np.sin(mu)], [12 * np.sin(mu), 8 + 4 * c]])
    m = np.array([[312 + 108 * c, -26 * np.sin(mu)], [-26 * np.sin(mu), 8 - 6 * c]]) / 420
    return abs(eigh(k, m)[1][0, 0])


def mean_ratio(mu):
    return (chain_ratio(mu) + hermite_ratio(mu)) / 2


def least_squares_order(error, counts):
    """Slope of log error over log count."""
    return -np.polyfit(np.log(counts), [np.log(abs(error(n))) for n in counts], 1)[0]


def law_order(ratio, n, counts):
    return least_squares_order(lambda count: ratio(n * np.pi / count) - 1, counts)


def timoshenko_ratio(n, nu, kappa):
    """Lower root of (1 - r2 x)(1 - s2 x) b4 = x in squares of frequency over Euler-Bernoulli's, pinned."""
    b2 = (n * np.pi * Paper.H / Paper.L) ** 2 / 12
    shear = b2 * 2 * (1 + nu) / kappa
    return np.sqrt(min(np.roots([b2 * shear, -(1 + b2 + shear), 1])))


def shape_of_links(mu, corrected):
    s2 = np.sin(mu / 2) ** 2
    return (1 - s2 / 3 if corrected else 1) / np.sqrt(1 - 2 * s2 / 3) - 1


MU = 22 * np.pi / 49
PAPER = {
    "exact-mode-22": lambda: pinned_hertz(22),
    "rayleigh-mode-22": lambda: pinned_hertz(22) / np.sqrt(1 + (22 * np.pi * Paper.H / Paper.L) ** 2 / 12),
    "timoshenko-mode-22": lambda: timoshenko_ratio(22, 0.33, 5 / 6) - 1,
    "segment-mode-22": lambda: chain_ratio(MU) - 1,
    "first-under-one-percent": lambda: enough_links(lambda n: chain_ratio(22 * np.pi / n) if n > 22 else 0, 1, 0.01),
    "fem-mode-22": lambda: hermite_ratio(MU) - 1,
    "segment-order": lambda: law_order(chain_ratio, 5, (40, 80, 160)),
    "fem-order": lambda: law_order(hermite_ratio, 5, (40, 80, 160)),
    "bracket-mode-22": lambda: pinned_hertz(22),
    "bracket-mode-5": lambda: pinned_hertz(5),
    "mean-mode-22": lambda: mean_ratio(MU) - 1,
    "mean-order": lambda: law_order(mean_ratio, 5, (20, 40, 80)),
    "segment-shape-22": lambda: shape_of_links(MU, True),
    "segment-raw-shape-22": lambda: shape_of_links(MU, False),
    "fem-shape-22": lambda: hermite_norm(MU) - 1,
}

# --- The wave between two forces ------------------------------------------------------------------------------------------


def kl_at(hertz, ratio=None, n=49):
    """KL that a beam, or n parts of a model, carries at a frequency."""
    exact = (2 * np.pi * hertz / Paper.C) ** 0.5 * Paper.L
    return brentq(lambda kl: kl * np.sqrt(ratio(kl / n)) - exact, 0.9 * exact, 1.1 * exact) if ratio else exact


def hertz_of(kl, ratio=None, n=49):
    return (kl / Paper.L) ** 2 * Paper.C / (2 * np.pi) * (ratio(kl / n) if ratio else 1)


def gamma(kl, phase=np.pi / 2):
    """|A-| / |A+| = |e^{i phase} - e^{-ikL}| / |e^{ikL} - e^{i phase}|, undamped, or its inverse."""
    found = abs(np.sin((kl + phase) / 2) / np.sin((kl - phase) / 2))
    return min(found, 1 / found)


def ratio_of(kl):
    """Of the standing wave at 90 degrees."""
    c = abs(np.cos(kl))
    return np.sqrt((1 + c) / (1 - c))


def amplitudes(place=Paper.D):
    """|A+|, |A-| of 1 N at `place` from both ends, 90 degrees apart: each force's two waves from both pins."""
    k, length = Paper.K, Paper.L
    unit = abs(np.sin(k * place)) / (4 * Paper.EI * k**3 * abs(np.sin(k * length)))
    turned = 1j * np.exp(1j * k * length)
    return tuple(sorted((unit * abs(1 + turned), unit * abs(1 - turned)), reverse=True))


def crest_speed(place):
    plus, minus = amplitudes(place)
    return -Paper.W * Paper.H / 2 * Paper.K * (plus**2 - minus**2) / np.hypot(plus, minus)


def flux():
    plus, minus = amplitudes()
    return Paper.EI * Paper.K**3 * Paper.W * (plus**2 - minus**2)


def mid_span():
    """Of both forces, each by Green's function."""
    k, d = Paper.K, Paper.D
    half = k * Paper.L / 2
    green = (np.sin(k * d) / (2 * np.cos(half)) - np.sinh(k * d) / (2 * np.cosh(half))) / (2 * Paper.EI * k**3)
    return green * (1 + 1j)


def modal_sum(x, forces, loss=0.0, zeta=0.0, modes=400_000):
    n = np.arange(1, modes + 1) * np.pi / Paper.L
    own = n**4 * Paper.EI / Paper.LINE
    below = own * (1 + 1j * loss) - Paper.W**2 + 2j * zeta * np.sqrt(own) * Paper.W
    push = sum(phasor((place, size, turn)) * np.sin(n * place) for place, size, turn in forces)
    return complex((2 / (Paper.LINE * Paper.L) * push * np.sin(n * x) / below).sum())


BOTH = ((Paper.D, 1.0, 0.0), (Paper.L - Paper.D, 1.0, 90.0))


def green(k, source, x, derivative=0):
    """Of the pinned beam without loss in EI: w or w' at x for 1 N at a place."""
    length, before = Paper.L, x < source
    a, b = np.where(before, x, length - x), np.where(before, length - source, source)
    side = np.where(before, 1.0, -1.0) if derivative else 1.0
    turn, grow = (np.cos, np.cosh) if derivative else (np.sin, np.sinh)
    far = turn(k * a) * np.sin(k * b) / np.sin(k * length)
    return side * (far - grow(k * a) * np.sinh(k * b) / np.sinh(k * length)) / (2 * Paper.EI * k ** (3 - derivative))


def exact_field(x, loss=0.0, phase=90.0, drive="force", derivative=0):
    """W or w' at x under the two forces, or under displacements imposed there, by Green's function."""
    k, lossy = Paper.K * (1 + 1j * loss) ** -0.25, 1 + 1j * loss
    places, given = np.array([Paper.D, Paper.L - Paper.D]), np.array([1.0, np.exp(1j * np.deg2rad(phase))])
    if drive == "displacement":
        given = np.linalg.solve(np.array([green(k, p, places) for p in places]).T, given)
    return sum(f * green(k, p, x, derivative) for p, f in zip(places, given, strict=True)) / lossy


def two_waves(loss=0.0, phase=90.0, drive="force"):
    """|A+|, |A-| at mid-span, complex k, fitted in [L/4, 3L/4] in the mean square."""
    k = Paper.K * (1 + 1j * loss) ** -0.25
    z, weights = np.polynomial.legendre.leggauss(200)
    x = Paper.L * (0.5 + z / 4)
    basis = np.exp(np.outer(x - Paper.L / 2, [-1j * k, 1j * k]))
    adjoint = basis.conj().T * weights
    return abs(np.linalg.solve(adjoint @ basis, adjoint @ exact_field(x, loss, phase, drive)))


def standing_ratio(**given):
    a, b = sorted(two_waves(**given))
    return (b + a) / (b - a)


def turned_crests():
    plus, minus = two_waves(loss=0.01, phase=-90.0)
    return -Paper.W * Paper.H / 2 * (Paper.K * (1 + 0.01j) ** -0.25).real * (plus**2 - minus**2) / np.hypot(plus, minus)


def area_spread(start, end, points=40_001):
    """Largest less least of 2 Im(conj(u) w) over its mean."""
    x = np.linspace(start, end, points)
    area = 2 * np.imag(np.conj(-Paper.H / 2 * exact_field(x, derivative=1)) * exact_field(x))
    return np.ptp(area) / abs(area.mean())


def per_degree(kl, width=0.5):
    here = gamma(kl)
    return sum(abs(gamma(kl, np.pi / 2 + np.deg2rad(side)) - here) for side in (-width, width))


def per_hertz(ratio, n, width=0.5):
    here = gamma(kl_at(4276.0, ratio, n))
    return sum(abs(gamma(kl_at(4276.0 + side, ratio, n)) - here) for side in (-width, width))


def wave_order(ratio, counts):
    exact = ratio_of(kl_at(4276.0))
    return least_squares_order(lambda n: ratio_of(kl_at(4276.0, ratio, n)) / exact - 1, counts)


SLIGHTLY = ((0.0731, 1.0, 0.0),)
LOSSY = Paper.W * 2e-5 * Paper.L / 196 / Paper.EI
WAVE = {
    "swr-law": lambda: ratio_of(kl_at(4276.0)),
    "distance-sets-no-ratio": lambda: ratio_of(kl_at(4276.0)),
    "distance-sets-the-amplitude": lambda: crest_speed(0.031),
    "reversal-keeps-the-ratio": lambda: standing_ratio(loss=0.01),
    "reversal-turns-the-wave": turned_crests,
    "signed-area": lambda: area_spread(0.125, 0.375),
    "signed-area-beside-the-forces": lambda: area_spread(0.0117, 0.4883),
    "surface-ellipse": lambda: -Paper.K * Paper.H / 2,
    "imposed-displacement": lambda: standing_ratio(drive="displacement"),
    "mid-span": mid_span,
    "segment-49-ratio": lambda: ratio_of(kl_at(4276.0, chain_ratio)),
    "fem-49-ratio": lambda: ratio_of(kl_at(4276.0, hermite_ratio)),
    "best-frequency": lambda: hertz_of(21.5 * np.pi),
    "segment-best-frequency": lambda: hertz_of(21.5 * np.pi, chain_ratio),
    "fem-best-frequency": lambda: hertz_of(21.5 * np.pi, hermite_ratio),
    "segment-ratio-order": lambda: wave_order(chain_ratio, (98, 196, 392)),
    "fem-ratio-order": lambda: wave_order(hermite_ratio, (98, 196, 392)),
    "travelling-index": lambda: 1 / ratio_of(kl_at(4276.0)),
    "envelope": lambda: gamma(kl_at(4276.0)),
    "flux": flux,
    "loss-on-elements": lambda: modal_sum(0.2137, BOTH, 0.01),
    "ratio-on-elements": lambda: modal_sum(0.2137, BOTH, 0.004, 0.013),
    "three-dampings-on-segments": lambda: modal_sum(0.2137, BOTH, 0.004 + LOSSY, 0.013),
    "dashpots-on-segments": lambda: modal_sum(0.2137, BOTH, LOSSY),
    "receptance-of-elements": lambda: modal_sum(0.2137, SLIGHTLY, 0.01),
    "receptance-of-segments": lambda: modal_sum(0.2137, SLIGHTLY),
    "reflection-per-hertz": lambda: per_hertz(hermite_ratio, 98),
    "reflection-per-degree": lambda: per_degree(kl_at(4276.0, chain_ratio, 196)),
}

# --- A cantilever's chain in 40 digits ------------------------------------------------------------------------------------


@cache
def clamped_root(mode):
    with mp.workdps(40):
        return mp.findroot(lambda y: mp.cos(y) + 1 / mp.cosh(y), (mode - mp.mpf(1) / 2) * mp.pi + (mode == 1) * 0.3)


@cache
def cantilever_of_links(mode, n, wall=(3 / 8, 7 / 6, 23 / 24), digits=40):
    """Error of a frequency of n links, EI = rho A = L = 1, by inverse iteration from LAPACK's vector."""
    with mp.workdps(digits):
        near = clamped_root(mode) ** 4
        unit = mp.mpf(1) / n
        soft = [mp.mpf(1)] * n
        for i, weight in enumerate(wall):
            soft[i] = weight
        stiff, mass = mp.zeros(n), mp.zeros(n)

        def add(matrix, entries, size):
            for i, a in entries:
                for j, b in entries:
                    if i and j:
                        matrix[i - 1, j - 1] += size * a * b

        for i in range(n):  # joint i between links i and i + 1; link 0 is the wall
            turn = [(i + 1, n), (i, -n)] + ([(i, -n), (i - 1, n)] if i else [])
            add(stiff, turn, n / soft[i])
            add(mass, [(i, mp.mpf(1) / 2), (i + 1, mp.mpf(1) / 2)], unit)
            add(mass, [(i, -n), (i + 1, n)], unit**3 / 12)
        known = eigh(np.array(stiff.tolist(), dtype=float), np.array(mass.tolist(), dtype=float))[1][:, mode - 1]
        v = mp.matrix(list(known))
        value = (v.T * stiff * v)[0] / (v.T * mass * v)[0]
        v = mp.lu_solve(stiff - value * mass, mass * v)
        value = (v.T * stiff * v)[0] / (v.T * mass * v)[0]
        return float(mp.sqrt(value / near) - 1)


def exact_gregory():
    return tuple(mp.mpf(a) / b for a, b in ((3, 8), (7, 6), (23, 24)))


def exact_five():
    return tuple(mp.mpf(a) / b for a, b in ((95, 288), (317, 240), (23, 30), (793, 720), (157, 160)))


def steel_links(mode, n, wall=GREGORY):
    """Frequency of the steel cantilever's links over the exact one's, dense."""
    beam = load_scene("steel-cantilever").beam
    found = Links(beam, [(beam.pieces[0], beam.length / n)] * n, wall).mode(mode)[0]
    return found / steel_hertz(mode)


def steel_hertz(mode):
    beam = load_scene("steel-cantilever").beam
    y = float(clamped_root(mode))
    return (y / beam.length) ** 2 * np.sqrt(beam.bending_stiffness / beam.mass_per_length) / (2 * np.pi)


def clamped_slope(mode, x):
    """W' of a clamped-free mode of modal mass 1 where rho A = L = 1."""
    y = float(clamped_root(mode))
    s = (np.cosh(y) + np.cos(y)) / (np.sinh(y) + np.sin(y))
    return y * (np.sinh(y * x) + np.sin(y * x) - s * (np.cosh(y * x) - np.cos(y * x)))


def contact_slope(mode, n, x, grading=1.0):
    """Largest error of a corrected spline's slope on the link at x, over the exact mode's largest slope.

    Every joint by the links on its two sides: y + (a^2 + b^2) y'' / 24, y'' by divided differences.
    """
    beam = load_scene("steel-cantilever").beam
    lengths = grading ** (np.arange(n) / max(n - 1, 1))
    lengths *= beam.length / lengths.sum()
    links = Links(beam, [(beam.pieces[0], one) for one in lengths])
    y = links.mode(mode)[1]
    tilt, read = np.diff(y) / lengths, y.copy()
    a, b = lengths[:-1], lengths[1:]
    read[1:-1] += (a**2 + b**2) / 24 * 2 * np.diff(tilt) / (a + b)
    line = CubicSpline(links.nodes, read, bc_type=((1, 0.0), (2, 0.0)))
    i = int(np.searchsorted(links.nodes, x, side="right") - 1)
    at = links.nodes[i] + lengths[i] * np.linspace(0, 1, 17)
    scale = 1 / np.sqrt(beam.mass_per_length * beam.length) / beam.length
    exact = clamped_slope(mode, at / beam.length) * scale
    largest = abs(clamped_slope(mode, links.nodes / beam.length)).max() * scale
    return abs(line(at, 1) - exact).max() / largest


def enough_after(error, most):
    """The least count from which on an error of links stays below, and the first below at all."""
    below = [abs(steel_links(2, n) - 1) <= error for n in range(6, most)]
    return max(i for i, held in enumerate(below) if not held) + 7, below.index(True) + 6


STEEL = {
    "exact-mode-1": lambda: steel_hertz(1),
    "gregory-mode-1": lambda: cantilever_of_links(1, 40, exact_gregory()),
    "gregory-mode-5": lambda: cantilever_of_links(5, 40, exact_gregory()),
    "gregory-mode-10": lambda: cantilever_of_links(10, 40, exact_gregory()),
    "five-joint-error": lambda: cantilever_of_links(2, 80, exact_five()),
    "half-wall-bracket": lambda: steel_hertz(3),
    "segments-for-a-tenth-of-a-per-cent": lambda: enough_links(lambda n: steel_links(10, n) if n > 10 else 0, 1, 1e-3),
    "segments-for-nine-ten-millionths": lambda: enough_after(9e-7, 60)[0],
    "segments-that-happen-to-do": lambda: enough_after(9e-7, 60)[1],
    "contact-line-at-the-wall": lambda: contact_slope(2, 40, 1e-3),
    "contact-line-on-unequal-links": lambda: contact_slope(2, 40, 0.25, 2.7),
}

# --- Free, guided and patched beams ---------------------------------------------------------------------------------------


def uniform_hertz(scene, y):
    beam = load_scene(scene).beam
    return (y / beam.length) ** 2 * np.sqrt(beam.bending_stiffness / beam.mass_per_length) / (2 * np.pi)


def free_root(mode):
    return brentq(lambda y: np.cos(y) - 1 / np.cosh(y), (mode + 0.3) * np.pi, (mode + 0.7) * np.pi, xtol=1e-14)


def guided_root(mode):
    with mp.workdps(30):
        return float(mp.findroot(lambda y: mp.tan(y) + mp.tanh(y), (mode - mp.mpf(1) / 4) * mp.pi))


def free_node():
    """Of cosh + cos - s (sinh + sin), over L."""
    y = free_root(1)
    s = (np.cosh(y) - np.cos(y)) / (np.sinh(y) - np.sin(y))
    return brentq(lambda x: np.cosh(y * x) + np.cos(y * x) - s * (np.sinh(y * x) + np.sin(y * x)), 0.1, 0.4, xtol=1e-15)


FREE = {
    "exact-mode-1": lambda: uniform_hertz("free-free-bar", free_root(1)),
    "bracket-mode-7": lambda: uniform_hertz("free-free-bar", free_root(7)),
    "node-of-the-first-mode": lambda: 0.42 * free_node(),
    "node-by-segments": lambda: 0.42 * free_node(),
    "node-by-elements": lambda: 0.42 * (1 - free_node()),
}
GUIDED = {
    "exact-mode-1": lambda: uniform_hertz("guided-bar", guided_root(1)),
    "exact-mode-6": lambda: uniform_hertz("guided-bar", guided_root(6)),
}


def patched(model, counts, grading=1.0):
    """Mode 9 of so many parts of each section, in a geometric row of `grading` from first to last, Hz."""
    beam, parts = load_scene("patched-strip").beam, []
    for piece, n in zip(beam.pieces, counts, strict=True):
        row = grading ** (np.arange(n) / max(n - 1, 1))
        parts += [(piece, one) for one in piece.length * row / row.sum()]
    return model(beam, parts).mode(9, *([0.2] if model is Elements else []))[0]


PATCHED = {
    "elements-at-24": lambda: patched(Elements, (1, 1, 20, 1, 1)),
    "segments-at-24": lambda: patched(Links, (1, 1, 20, 1, 1)),
    "graded-elements-at-24": lambda: patched(Elements, (1, 1, 20, 1, 1), 1.7),
    "graded-segments-at-24": lambda: patched(Links, (1, 1, 20, 1, 1), 1.7),
    "elements-at-96": lambda: patched(Elements, (1, 3, 86, 5, 1)),
    "graded-segments-at-96": lambda: patched(Links, (1, 3, 86, 5, 1), 1.7),
}

# --- A moving force, friction, a slider that is carried -----------------------------------------------------------------


def moving_force(x, time, terms=20_000):
    """Of Fryba's beam: undamped, from rest."""
    scene = load_scene("moving-load")
    beam, slider = scene.beam, scene.slider
    n = np.arange(1, terms + 1) * np.pi / beam.length
    own = n**2 * np.sqrt(beam.bending_stiffness / beam.mass_per_length)
    w = n * slider.speed
    small = abs(w / own - 1) < 1e-9
    own = np.where(small, own * (1 + 1e-7), own)
    parts = (np.sin(w * time) - w / own * np.sin(own * time)) / (own**2 - w**2)
    return (
        -2
        * (slider.preload + slider.mass * GRAVITY)
        / (beam.mass_per_length * beam.length)
        * (parts * np.sin(n * x)).sum()
    )


MOVING = {
    "largest-deflection": lambda: moving_force(0.415, 0.09549464496871184),
    "largest-deflection-segments": lambda: moving_force(0.415, 0.09549464496871184),
    "largest-deflection-elements": lambda: moving_force(0.415, 0.09549464496871184),
    "on-the-way": lambda: moving_force(0.249, 0.05729678696690633),
}


def mean_of_the_wave(amplitude):
    """-(k omega A^2 / 2)(1 + (k h/2)^2)."""
    return -Paper.K * Paper.W * amplitude**2 / 2 * (1 + (Paper.K * Paper.H / 2) ** 2)


def loaded(x, mass, place):
    """Of the driven beam with a mass on it: the force m omega^2 w at its place, by receptances of 60 digits."""
    beam = load_scene("paper-slider").beam

    def receptance(at):
        return unit_field(beam, "euler-bernoulli", 4276.0, place, at)[0]

    own = mass * Paper.W**2
    return exact_field(x) + receptance(x) * own * exact_field(place) / (1 - own * receptance(place))


SLIDER_MASS = 1.0193679918450561e-3


def held_steady(x=0.31, time=0.83e-3):
    """The loaded field at a time on the sag of a weight at mid-span."""
    b, length = Paper.L - x, Paper.L
    sag = SLIDER_MASS * GRAVITY * b * (length / 2) * (length**2 - b**2 - (length / 2) ** 2) / (6 * Paper.EI * length)
    return (loaded(x, SLIDER_MASS, 0.25) * np.exp(1j * Paper.W * time)).real - sag


def stick_slip():
    m, k, most, least, v = 0.7, 310.0, 2.9, 1.7, 0.11
    w = np.sqrt(k / m)
    return 2 * (most - least) / (k * v), 2 / w * (np.pi - np.arctan((most - least) * w / (k * v)))


def pure_amplitude():
    """Of the wave at the phase -kL: 2 |sin kd| / (4 EI k^3)."""
    return abs(np.sin(Paper.K * Paper.D)) / (2 * Paper.EI * Paper.K**3)


def at_once(modes, times, x=0.25):
    """w', dw/dt, dw'/dt, dw''/dt of the pinned beam at x under cos wt and -sin wt from rest, (4, n): a sum of sines."""
    n = np.arange(1, modes + 1) * np.pi / Paper.L
    own, w = n**2 * Paper.C, Paper.W
    left, right = (2 / (Paper.LINE * Paper.L) * np.sin(n * p) / (own**2 - w**2) for p in (Paper.D, Paper.L - Paper.D))
    across, slope, bend = np.sin(n * x), n * np.cos(n * x), -(n**2) * np.sin(n * x)

    def parts(t):
        c, s, driven = np.cos(np.outer(t, own)), np.sin(np.outer(t, own)), np.array([np.cos(w * t), np.sin(w * t)])

        def rate(shape):
            forced = -w * np.array([shape @ right, shape @ left]) @ driven
            return forced + s @ (shape * left * own) + c @ (shape * right * w)

        still = np.array([slope @ left, -slope @ right]) @ driven - c @ (slope * left) + s @ (slope * right * w / own)
        return np.array([still, rate(across), rate(slope), rate(bend)])

    return np.concatenate([parts(block) for block in np.array_split(times, 20)], axis=1)


def slider_at_once(modes=800, steps=25_000, friction=0.2 * GRAVITY, slope=1e4):
    """Way of a slider of Eq. (3) in 1 ms, x'' = -mu g tanh(K (x' - v)), v the surface's at x to second order."""
    turned, rise, turning, bending = at_once(modes, np.linspace(0.0, 1e-3, 2 * steps + 1))
    half, h = Paper.H / 2, 1e-3 / steps
    flat, tilt = (turned * rise - half * turning - half * bending * half * turned).tolist(), (-half * bending).tolist()
    x = v = 0.0

    def pull(j, x, v):
        return -friction * math.tanh(slope * (v - flat[j] - tilt[j] * x))

    for j in range(0, 2 * steps, 2):
        a = pull(j, x, v)
        b = pull(j + 1, x + h / 2 * v, v + h / 2 * a)
        c = pull(j + 1, x + h / 2 * (v + h / 2 * a), v + h / 2 * b)
        d = pull(j + 2, x + h * (v + h / 2 * b), v + h * c)
        x, v = x + h * v + h * h / 6 * (a + b + c), v + h / 6 * (a + 2 * b + 2 * c + d)
    return x


def turned(place, hertz=4276.0):
    """Slope of the paper's beam under a unit couple there, two waves and two near fields between its pins, 30 digits."""
    with mp.workdps(30):
        k = mp.sqrt(2 * mp.pi * hertz / mp.sqrt(mp.mpf(Paper.EI) / Paper.LINE))
        a, b = k * mp.mpf(place), k * (Paper.L - mp.mpf(place))
        waves, near = mp.cos(a) * mp.cos(b) / mp.sin(a + b), mp.cosh(a) * mp.cosh(b) / mp.sinh(a + b)
        return abs(float((near - waves) / (2 * Paper.EI * k)))


def friction_size():
    return 2e-3 * Paper.H / 2 * turned(0.25) / abs(exact_field(0.25, derivative=1))


def friction_size_elsewhere():
    """At 0.2137 m and 4465 Hz, two thousandths of the way to a resonance: slopes by Green's function in 60 digits."""
    beam = load_scene("paper-slider").beam
    slopes = [unit_field(beam, "euler-bernoulli", 4465.0, at, 0.2137)[1] for at in (Paper.D, Paper.L - Paper.D)]
    return 2e-3 * Paper.H / 2 * turned(0.2137, 4465.0) / abs(slopes[0] + 1j * slopes[1])


def normal_size():
    half = Paper.K * Paper.L / 2
    return SLIDER_MASS * Paper.W**2 * abs(np.tan(half) - np.tanh(half)) / (4 * Paper.EI * Paper.K**3)


SLIDER = {
    "free-decay": lambda: float(
        mp.asinh(mp.sinh(mp.mpf("11.7")) * mp.exp(-mp.mpf("0.23") * mp.mpf("9.81") * 900 * mp.mpf("0.0041"))) / 900
    ),
    "creep": lambda: float(mp.atanh(mp.mpf("1.1") / (mp.mpf("0.23") * mp.mpf("9.81"))) / 900),
    "belt-stick-time": lambda: stick_slip()[0],
    "belt-slip-time": lambda: stick_slip()[1],
    "coulomb-decrement": lambda: 4 * 1.7 / 310.0,
    "terminal-speed-flat": lambda: mean_of_the_wave(2.3e-7),
    "terminal-speed-steep": lambda: 2 * mean_of_the_wave(2.3e-7),
    "terminal-speed-quarter": lambda: mean_of_the_wave(1.15e-7),
    "terminal-speed-following": lambda: -Paper.K * Paper.W * 2.3e-7**2 / 2 * (Paper.K * Paper.H / 2) ** 2,
    "slider-at-once": slider_at_once,
    "slider-step-steep": lambda: slider_at_once(slope=1e6, steps=50_000),
    "slider-against-the-wave": lambda: 2 * mean_of_the_wave(pure_amplitude()),
    "slider-reversed": lambda: -2 * mean_of_the_wave(pure_amplitude()),
    "chain-slider-saturates": lambda: 0.2 * SLIDER_MASS * GRAVITY,
    "friction-size": friction_size,
    "friction-size-near-a-resonance": friction_size_elsewhere,
    "normal-size": normal_size,
    "loaded-exact": lambda: loaded(0.31, 1.3e-3, 0.2137),
    "loaded-segments": lambda: loaded(0.31, SLIDER_MASS, 0.25),
    "loaded-elements": lambda: loaded(0.31, SLIDER_MASS, 0.25),
    "held-steady-segments": held_steady,
    "held-steady-elements": held_steady,
}
HEAVY_SLIDER = {
    "books-contact": lambda: ridden("massless")["contact_on_beam"],
    "books-contact-one-way": lambda: ridden("massless", felt=False)["contact_on_beam"],
    "books-damped": lambda: ridden("massless")["damped"],
    "books-reaction": lambda: ridden("held")["normal_on_beam"],
    "books-way": lambda: ridden("held")["displacement"],
    "coulomb-slides": lambda: 0.5 * 0.021 * ((0.4 - 0.31 * GRAVITY * 4e-4) ** 2 - 0.4**2),
}

# --- The nonlinear chain --------------------------------------------------------------------------------------------------


def rolled_gap(n, weights):
    """Ends of n links apart after a moment of 2 pi EI / L, over L; weights are the first joints' softness."""
    soft = np.ones(n)
    soft[: len(weights)] = weights
    ends = np.cumsum(np.exp(1j * np.cumsum(2 * np.pi / n * soft)) / n)
    return abs(ends[-1])


def two_bars():
    """Second frequency of two hanging uniform bars, omega sqrt(L/g), L = 2 l = 1."""
    mass = np.array([[4 / 3, 1 / 2], [1 / 2, 1 / 3]]) / 8
    stiff = np.diag([3 / 2, 1 / 2]) / 4
    return np.sqrt(eigh(stiff, mass, eigvals_only=True)[1])


def flapping(mode, speed, terms=160):
    """Omega of a turning cantilever across its plane, by a power series in 60 digits, EI = rho A = L = 1."""
    with mp.workdps(60):
        turned = mp.mpf(speed) ** 2

        def end(square):
            columns = []
            for first in (2, 3):
                a = [mp.mpf(0)] * (terms + 5)
                a[first] = mp.mpf(1)
                for n in range(terms):  # w'''' = (T w')' + omega^2 w, T = speed^2 (1 - x^2) / 2
                    pull = turned / 2 * ((n + 2) * (n + 1) * a[n + 2] - n * (n + 1) * a[n])
                    a[n + 4] = (pull + square * a[n]) / ((n + 4) * (n + 3) * (n + 2) * (n + 1))
                bend = mp.fsum(a[n] * n * (n - 1) for n in range(terms))
                shear = mp.fsum(a[n] * n * (n - 1) * (n - 2) for n in range(terms))
                columns.append((bend, shear))
            return columns[0][0] * columns[1][1] - columns[0][1] * columns[1][0]

        at, step, left = mp.mpf("0.5"), mp.mpf("2.5"), mode
        while True:
            if end(at**2) * end((at + step) ** 2) < 0:
                left -= 1
                if not left:
                    return mp.findroot(lambda w: end(w**2), (at, at + step), solver="anderson", tol=1e-40)
            at += step


def lead_lag(mode, speed):
    return float(mp.sqrt(flapping(mode, speed) ** 2 - speed**2))


def linear_links(x=0.25, time=1e-3, n=49):
    """The paper's linear chain from rest under sin and cos at its ends, 1 N: all modes, lever rule."""
    beam = load_scene("chain").beam
    links = Links(beam, [(beam.pieces[0], beam.length / n)] * n)
    keep = np.ix_(links.free, links.free)
    values, vectors = eigh(links.bent[keep], links.mass[keep])
    own, total = np.sqrt(values), 0.0
    for place, turn in ((Paper.D, -np.pi / 2), (Paper.L - Paper.D, 0.0)):
        gain = (links.row(place)[links.free] @ vectors) / (values - Paper.W**2)
        now = np.cos(Paper.W * time + turn) - np.cos(turn) * np.cos(own * time)
        total += gain * (now + np.sin(turn) * Paper.W / own * np.sin(own * time))
    return links, vectors, total, float(links.row(x)[links.free] @ vectors @ total)


def dead_load_share(n=100, load=4.0):
    """Tip of n links of least energy off the elastica's, the worse component, over load / (12 n^2), EI = L = 1."""
    springs, theta = np.full(n, 1.0 * n), np.zeros(n)
    springs[:3] /= GREGORY
    for part in np.linspace(0.1, 1.0, 10):
        for _ in range(40):
            angle = np.cumsum(theta)
            ahead = [np.cumsum(one[::-1])[::-1] / n for one in (np.cos(angle), np.sin(angle))]
            later = np.maximum.outer(np.arange(n), np.arange(n))
            stiff = np.diag(springs) + part * load * ahead[1][later]
            theta = theta - np.linalg.solve(stiff, springs * theta - part * load * ahead[0])
    angle = np.cumsum(theta)
    tip = np.sin(angle).mean(), 1 - np.cos(angle).mean()
    return max(abs(a - b) for a, b in zip(tip, elastica_tip(load), strict=True)) / (load / (12 * n**2))


CHAIN = {
    "elastica-deflection": lambda: float(elastica_tip(4.0)[0]),
    "elastica-shortening": lambda: float(elastica_tip(4.0)[1]),
    "rollup-closes": lambda: rolled_gap(20, [0.5]),
    "rollup-gap-of-gregory": lambda: rolled_gap(20, GREGORY),
    "hanging-one-link": lambda: np.sqrt(1.5),
    "hanging-two-links": two_bars,
    "hanging-limit": lambda: jn_zeros(0, 2)[1] / 2,
    "turning-slow": lambda: lead_lag(1, 3.0),
    "turning-fast": lambda: lead_lag(1, 12.0),
    "turning-third-mode": lambda: lead_lag(3, 12.0),
    "large-amplitude": lambda: float(woinowsky_krieger(2.0)),
    "small-force": lambda: 0.1 * linear_links()[3],
    "ten-newton-without-axial-inertia": lambda: 10 * linear_links()[3],
    "small-force-linear": lambda: 0.1 * linear_links()[3],
}


def clasp(steps=480, periods=24, last=12, speed=-0.0213):
    """(force, surface's power, share of points in contact) of `preloaded-motor` held at a speed, its last periods.

    One of its two feet, which are mirror images, from the height of a layer at rest: height and pitch on 15 springs with
    dashpots that never pull, on the two waves of the exact field, read where the material is. Friction turns nothing.
    """
    mass, length, points, stiffness, damping, load, mu = 0.005, 0.0465, 15, 6.3e4, 0.1, 0.1, 0.2
    k, w, half, inertia = Paper.K, Paper.W, Paper.H / 2, mass * length**2 / 12
    x, s = np.linspace(0.23, 0.27, 41), length * ((np.arange(points) + 0.5) / points - 0.5)
    waves = np.exp(np.outer(x - Paper.L / 2, [-1j * k, 1j * k]))
    (a, b), *_ = np.linalg.lstsq(waves, 9.0 * exact_field(x), rcond=None)

    def line(at, t):
        ahead, back = a * np.exp(1j * (w * t - k * at)), b * np.exp(1j * (w * t + k * at))
        both, tilt = ahead + back, 1j * k * (back - ahead)
        return both.real, -w * both.imag, tilt.real, -w * tilt.imag

    def touched(t, y):
        """(what every point is pressed by, speed of the surface below it)."""
        _, _, tilt, turn = line(s, t)
        height, lift, slope, twist = line(s + half * tilt, t)
        deep, closing = height - y[0] - y[2] * s, lift + slope * half * turn - y[1] - y[3] * s
        push = np.where(deep > 0, np.maximum(stiffness * deep + damping * closing, 0.0), 0.0) / points
        return push, (lift * slope - half * twist) / np.sqrt(1 + slope**2)

    def rates(t, y):
        push, _ = touched(t, y)
        return np.array([y[1], (push.sum() - load) / mass, y[3], push @ s / inertia])

    y, h, found = np.array([abs(a) * np.cos(1.0212), 0.0, 0.0, 0.0]), 2 * np.pi / w / steps, np.zeros(3)
    push, along = touched(0.0, y)
    for i in range(periods * steps):
        one = rates(i * h, y)
        two = rates((i + 0.5) * h, y + h / 2 * one)
        three = rates((i + 0.5) * h, y + h / 2 * two)
        y = y + h / 6 * (one + 2 * two + 2 * three + rates((i + 1) * h, y + h * three))
        before, was = push, along
        push, along = touched((i + 1) * h, y)
        if i >= (periods - last) * steps:
            way = (was + along - 2 * speed) / (abs(was - speed) + abs(along - speed))  # the mean sign over the step
            drag = mu * 0.5 * (before + push) * way
            found += [2 * drag.sum(), drag @ (was + along), np.mean(push > 0)]
    return found / (last * steps)


clasp = cache(clasp)
MOTOR = {
    "share-of-contact": lambda: clasp()[2],
    "force-at-three-quarters": lambda: clasp()[0],
    "power-at-three-quarters": lambda: -0.0213 * clasp()[0],
    "efficiency-at-three-quarters": lambda: -0.0213 * clasp()[0] / clasp()[1],
}


def graded_order(mode=3, grading=1.7, sizes=((20, 28), (40, 56), (80, 112))):
    """Observed order of links in geometric rows on both sections of the stepped beam."""
    beam, found = load_scene("stepped-beam").beam, []
    for size in sizes:
        rows = [grading ** (np.arange(n) / (n - 1)) for n in size]
        parts = [
            (piece, one * piece.length / row.sum()) for piece, row in zip(beam.pieces, rows, strict=True) for one in row
        ]
        found.append(Links(beam, parts).mode(mode)[0])
    errors = abs(np.array(found) / frequency_near(beam, "euler-bernoulli", found[-1]) - 1)
    return -np.polyfit(np.log(np.sum(sizes, axis=1)), np.log(errors), 1)[0]


STEPPED = {
    "graded-segments": graded_order,
    "exact-mode-1": lambda: frequency_near(load_scene("stepped-beam").beam, "euler-bernoulli", 25.2475),
    "exact-mode-6": lambda: frequency_near(load_scene("stepped-beam").beam, "euler-bernoulli", 666.276),
}

KNOWN = {
    "stress": {"dead-load": dead_load_share},
    "stepped-beam": STEPPED,
    "paper": PAPER,
    "paper-wave": WAVE,
    "steel-cantilever": STEEL,
    "free-free-bar": FREE,
    "guided-bar": GUIDED,
    "patched-strip": PATCHED,
    "moving-load": MOVING,
    "paper-slider": SLIDER,
    "heavy-slider": HEAVY_SLIDER,
    "preloaded-motor": MOTOR,
    "chain": CHAIN,
}
"""By scene and gate."""
