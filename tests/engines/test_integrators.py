"""Time steps of a chain without an engine: closed forms, each against another derivation of the same multipliers."""

from math import inf, pi, sqrt

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.optimize import linear_sum_assignment

from verify import Beam, SegmentModel
from verify.engines.choice import armature, band, choose, compensated, largest_mode, largest_step, rayleigh, trade
from verify.engines.description import Steps
from verify.engines.integrators import INTEGRATORS, scheme_of
from verify.engines.steps import Simulated
from verify.errors import InputError
from verify.linear import step_schemes as table
from verify.linear.step_schemes import generalised_alpha, newmark

STRIP = Beam(
    length=0.6, width=0.025, thickness=0.003, youngs_modulus=70e9, density=2700.0, supports=("clamped", "free")
)
C = 4.409586  # sqrt(EI/rho A), m2/s
A, B, IE, CD = table.IMPLICIT_DASHPOTS, table.EXPLICIT_DASHPOTS, table.IMPLICIT_EULER, table.CENTRAL
EVERY = [A, B, IE, CD, newmark(0.25), newmark(1 / 12), newmark(0.3, 0.6), generalised_alpha(0.5),
         *{id(row.scheme): row.scheme for row in INTEGRATORS if row.scheme}.values()]  # fmt: skip


def stepped(mass, damping, stiffness, step, scheme, **more):
    return Simulated(mass, damping, stiffness, step, scheme, **more)


def mode(x, zeta, scheme):
    """One mode, omega = 1, at step x."""
    return stepped(np.eye(1), np.full((1, 1), 2.0 * zeta), np.eye(1), x, scheme)


def apart(first, second):
    """Largest distance of two sets of multipliers, paired by the nearest."""
    distance = abs(np.ravel(first)[:, None] - np.ravel(second))
    assert distance.shape[0] == distance.shape[1]
    return distance[linear_sum_assignment(distance)].max()


def strip(n, zeta=0.0, **more):
    return SegmentModel(STRIP, n).rigid_chain(damping=zeta, **more)


def random_system(n=6):
    """M, C, K positive, C not proportional."""
    rng = np.random.default_rng(3)
    return [a @ a.T + shift * np.eye(n) for a, shift in ((rng.standard_normal((n, n)), s) for s in (2.0, 0.1, 9.0))]


EXPLICIT = {  # the code of an engine: new velocity, new position of q'' + 2 z q' + q = 0
    A: lambda q, v, h, z: (q + h * (w := (v - h * q) / (1 + 2 * z * h)), w),
    B: lambda q, v, h, z: (q + h * (w := v - h * (q + 2 * z * v)), w),
    IE: lambda q, v, h, z: (q + h * (w := (v - h * q) / (1 + 2 * z * h + h * h)), w),
}


@pytest.mark.parametrize("scheme", EXPLICIT, ids=lambda one: one.name)
def test_multipliers_are_those_of_one_step_of_the_state(scheme):
    for x, zeta in ((0.3, 0.02), (1.1, 0.2), (1.7, 0.07)):
        step = np.array([EXPLICIT[scheme](*e, x, zeta) for e in np.eye(2)]).T
        found = {other: apart(mode(x, zeta, other).multipliers, np.linalg.eigvals(step)) for other in EXPLICIT}
        assert found.pop(scheme) < 1e-12
        assert min(found.values()) > 1e-4  # another scheme is not mistaken for it


@pytest.mark.parametrize(("scheme", "other"), [(IE, None), (table.TRAPEZOIDAL, newmark(0.25))])
def test_whole_state_schemes_map_poles_for_any_dashpots(scheme, other):
    system, h = random_system(), 0.37
    state = np.block([[np.zeros((6, 6)), np.eye(6)], [-np.linalg.solve(system[0], np.hstack(system[2:0:-1]))]])
    z, one = h * state, np.eye(12)
    step = np.linalg.inv(one - z) if scheme is IE else np.linalg.solve(one - z / 2, one + z / 2)
    both = [stepped(*system, h, made) for made in (scheme, other) if made]
    for made in both:
        assert apart(made.multipliers, np.linalg.eigvals(step)) < 1e-9
        assert apart(made.poles.s, np.linalg.eigvals(state)) < 1e-9
    assert apart(stepped(*system, h / 2, scheme).multipliers, np.linalg.eigvals(step)) > 1e-3
    assert both[0].modes.hz == pytest.approx(both[-1].modes.hz, rel=1e-9)


@pytest.mark.parametrize("scheme", [A, B, CD, newmark(0.1), newmark(0.0, 0.8)], ids=lambda one: one.name)
def test_limit_of_coupled_dashpots_is_where_the_radius_leaves_one(scheme):
    mass, damping, stiffness = random_system()
    limit = stepped(mass, damping, stiffness, 1.0, scheme).limit
    inside, beyond = (
        abs(stepped(mass, damping, stiffness, limit * by, scheme).multipliers).max() for by in (0.999, 1.001)
    )
    assert inside < 1.0 < 1.0 + 1e-4 < beyond


@pytest.mark.parametrize(("x", "zeta"), [(0.3, 0.02), (1.1, 0.2), (1.5, 0.05)])
def test_decay_and_frequency_are_the_closed_forms(x, zeta):
    d = 2 * zeta * x
    decay = {A: np.log(1 + d) / 2, B: -np.log(1 - d) / 2, IE: np.log(1 + d + x * x) / 2,
             CD: np.log((1 + d / 2) / (1 - d / 2)) / 2}  # fmt: skip
    cosine = {A: (2 + d - x * x) / (2 * sqrt(1 + d)), B: (2 - d - x * x) / (2 * sqrt(1 - d)),
              IE: (1 + zeta * x) / sqrt(1 + d + x * x), CD: (2 - x * x) / (2 * sqrt(1 - (zeta * x) ** 2))}  # fmt: skip
    for scheme, sigma in decay.items():
        theta, modes = np.arccos(cosine[scheme]), mode(x, zeta, scheme).modes
        assert modes.hz[0] == pytest.approx(theta / (2 * pi * x), rel=1e-12)
        assert modes.zeta[0] == pytest.approx(sigma / np.hypot(sigma, theta), rel=1e-12)
        assert modes.file_zeta[0] == pytest.approx(zeta, rel=1e-12)


@pytest.mark.parametrize("scheme", EVERY, ids=lambda one: one.name)
def test_row_of_a_scheme_has_its_errors_and_its_limit(scheme):
    """Richardson's extrapolation of the errors, bisection of the spectral radius."""
    (fast, p), (damped, q) = scheme.frequency, scheme.numerical
    found = []
    for x in (0.04, 0.02):
        modes = mode(x, 0.0, scheme).modes
        found.append(((2 * pi * modes.hz[0] - 1.0) / x**p, modes.zeta[0] / x**q))
    first, second = (fine + (fine - coarse) / 3 for coarse, fine in zip(*found, strict=True))
    assert (first, second) == pytest.approx((fast, damped), rel=0.01, abs=1e-9)
    assert mode(1.0, 0.0, scheme).limit == pytest.approx(scheme.limit, rel=1e-4)
    if scheme.limit == inf:
        assert all(abs(mode(x, zeta, scheme).multipliers).max() < 1 + 1e-9 for x in (3, 90) for zeta in (0, 0.01, 2))
    else:
        sizes = [abs(mode(max(scheme.limit, 0.02) * by, 0.0, scheme).multipliers).max() for by in (0.999, 1.001)]
        assert sizes[1] > 1 + 1e-9
        assert sizes[0] < 1 + 1e-9 or not scheme.limit


def test_limits_with_dashpots():
    assert mode(1, 0.07, A).limit == pytest.approx(2 * 0.07 + 2 * sqrt(0.07**2 + 1), rel=1e-12)
    assert mode(1, 0.07, B).limit == pytest.approx(2 * sqrt(0.07**2 + 1) - 2 * 0.07, rel=1e-12)
    assert mode(1, 0.6, CD).limit == pytest.approx(2.0, rel=1e-12)
    assert mode(1, 50.0, table.RK4).limit == pytest.approx(2.7853 / (50 + sqrt(2499)), rel=1e-4)
    flips = mode(2.65, 0.3, A).modes  # both roots real and negative
    assert np.isnan(flips.hz[0])
    for share, radius in ((0.45, 1.1), (0.55, 1.0)):  # dashpots b K with b = h/2 run at every step
        assert (abs(mode(400.0, share * 400.0 / 2, A).multipliers).max() > radius) == (share < 0.5)


def test_armature_in_proportion_to_stiffness():
    plain = strip(12).simulated(1e-3, "mujoco")
    heavy = stepped(plain.mass + 4e-8 * plain.stiffness, plain.damping, plain.stiffness, 1e-3, A)
    assert heavy.modal[0] ** -2 == pytest.approx(plain.modal[0] ** -2 + 4e-8, rel=1e-10)
    equal = stepped(plain.mass + 4e-8 * plain.stiffness[5, 5] * np.eye(12), plain.damping, plain.stiffness, 1e-3, A)
    assert abs(equal.modal[0] ** -2 / heavy.modal[0] ** -2 - 1.0).max() > 1e-3  # not by the weights at the wall
    for h, zeta in ((1e-3, 0.003), (2e-3, 0.0025)):
        file = strip(12, zeta).simulated(h, "mujoco")
        assert file.step > file.limit
        trapezoidal = strip(12, zeta).simulated(h, "exudyn", "TrapezoidalIndex2")
        run = stepped(file.mass + np.diag(armature(file)), file.damping, file.stiffness, h, A)
        assert apart(run.multipliers, trapezoidal.multipliers) < 1e-9
        wrong = stepped(file.mass + h**2 / 4 * file.stiffness, file.damping, file.stiffness, h, A)
        assert apart(wrong.multipliers, trapezoidal.multipliers) > 1e-4
    small = strip(12, 0.01).simulated(2e-4, "newton", "featherstone")
    run = stepped(small.mass + np.diag(armature(small)), small.damping, small.stiffness, 2e-4, B)
    assert apart(run.multipliers, strip(12, 0.01).simulated(2e-4, "exudyn", "Newmark").multipliers) < 1e-9
    with pytest.raises(InputError, match="armature"):
        armature(strip(5).simulated(1e-3, "dart"))


@pytest.mark.parametrize(("wall", "figures"), [
    ("gregory", (5.803, 6.330, 6.556, 6.743, 6.855, 6.908)), ("full", (5.757, 6.309, 6.545, 6.739, 6.854, 6.908)),
    ("half", (5.796, 6.323, 6.551, 6.741, 6.854, 6.908)),
])  # fmt: skip
def test_highest_frequency_of_bending(wall, figures):
    for n, figure in zip((4, 6, 8, 12, 20, 40), figures, strict=True):
        top = SegmentModel(STRIP, n, wall=wall).rigid_chain().simulated(1e-3, "mujoco").omega_max
        assert top * (0.6 / n) ** 2 / C == pytest.approx(figure, abs=6e-4)


def test_highest_frequencies_by_formula():
    for n in (5, 12):
        s = np.sin((n - 1) * pi / (2 * n))
        pinned = SegmentModel(Beam(length=0.6, width=0.025, thickness=0.003, youngs_modulus=70e9, density=2700.0), n)
        top = pinned.rigid_chain().simulated(1e-3, "drake").omega_max
        assert top == pytest.approx(sqrt(16 * s**4 / (1 - 2 * s * s / 3)) * C * (n / 0.6) ** 2, rel=1e-6)
        rod = Beam(length=0.6, shape="round", diameter=0.01, poissons_ratio=0.3, youngs_modulus=70e9, density=2700.0,
                   supports=("clamped", "free"))  # fmt: skip
        chain = SegmentModel(rod, n).rigid_chain(in_space=True)
        shear = sqrt(chain.joints[1].hinge("torsion").stiffness / chain.links[1].inertia[0])
        twist = chain.simulated(1e-5, "mujoco", axis="torsion")
        assert twist.omega_max == pytest.approx(2 * shear * np.cos(pi / (4 * n)), rel=1e-9)
        whole = chain.simulated(1e-5, "mujoco")
        assert whole.limit == pytest.approx(twist.limit if n == 12 else min(twist.limit, whole.limit), rel=1e-9)
    assert whole.limit == pytest.approx(15.87e-6, rel=3e-4)  # measured in MuJoCo 4.0.0
    flat = strip(12, in_space=True).simulated(1e-5, "mujoco")
    assert flat.limit == pytest.approx(22.49e-6, rel=3e-4)  # measured, as above


@pytest.mark.parametrize(("h", "most"), [(1e-5, 48), (1e-4, 15), (2e-4, 11), (1e-3, 5)])
def test_most_links_at_a_step(h, most):
    stable = [one.simulated(h, "mujoco").stable for one in (strip(most), strip(most + 1))]
    assert stable == [True, False]


def test_one_dashpot_damps_a_mode_only_up_to_a_maximum():
    file = strip(12).simulated(1e-3, "mujoco")
    locked = np.diag([1e9] + [0.0] * 11)
    omega, stiff = (
        stepped(file.mass, file.damping, k, 1e-3, A).modal[0][0] for k in (file.stiffness, file.stiffness + locked)
    )
    most = (stiff - omega) / (2 * omega)
    found = [stepped(file.mass, np.diag([c] + [0.0] * 11), file.stiffness, 1e-3, A).modes.file_zeta[0]
             for c in np.geomspace(0.05, 50, 200)]  # fmt: skip
    assert (most, max(found)) == pytest.approx((0.03435, 0.03437), abs=1e-5)
    # dashpots of two joints that give two modes 1 % by the first-order formula
    angles = file.modal[2][[3, 11], :2] ** 2 / (2 * file.modal[0][:2])
    c = np.linalg.solve(angles.T, [0.01, 0.01])
    damping = np.zeros((12, 12))
    damping[3, 3], damping[11, 11] = c
    ratios = stepped(file.mass, damping, file.stiffness, 1e-3, A).modes.file_zeta[:2]
    assert 100 * ratios == pytest.approx([0.985, 0.176], rel=0.01)


@pytest.mark.parametrize("scheme", [A, B, IE, CD, newmark(0.3, 0.6)], ids=lambda one: one.name)
def test_compensated_dashpots_give_the_decay(scheme):
    for zeta, x in ((0.01, 0.01), (0.05, 0.0934)):
        sim = mode(x, compensated(scheme, zeta, 1.0, x), scheme).modes
        assert 2 * pi * sim.hz[0] * sim.zeta[0] / sqrt(1 - sim.zeta[0] ** 2) == pytest.approx(zeta, rel=1e-11)
    with pytest.raises(InputError, match="damping"):
        compensated(table.RK4 if scheme is not IE else IE, 0.01, 1.0, 0.021)


def test_drag_and_dashpots_by_closed_forms():
    fit = rayleigh([43.0, 270.0], [0.01, 0.02])
    assert [fit.drag / (2 * w) + fit.dashpots * w / 2 for w in (43, 270)] == pytest.approx([0.01, 0.02], rel=1e-9)
    assert rayleigh([43.0], [0.01]).dashpots == pytest.approx(0.02 / 43, rel=1e-12)
    for ratio, percent in ((6.267, 18.4), (17.548, 37.8), (34.39, 50.2)):
        assert 100 * abs(band(2.0, 2.0 * ratio, 0.03).deviation) == pytest.approx([percent] * 3, abs=0.06)
    with pytest.raises(InputError, match="89"):
        band(43.0, 43.0 * 17.548, 0.01, drag=False, within=0.1)


def test_links_for_a_step_by_the_trade():
    rows = trade([strip(n, 0.01) for n in (4, 5, 6, 8, 12)], Steps(1e-3, "MuJoCo"))
    assert choose(rows, 2, 0.01).chain.count == 6
    assert choose(rows, 3, 0.01) is None
    assert largest_mode(rows, 0.01) == 2
    assert [row.chain.count for row in rows if row.beta] == [8, 12]
    assert all(row.limit > 1e-3 for row in rows if row.beta)
    plain = trade([strip(8)], Steps(1e-4, "MuJoCo"))[0]
    assert 100 * plain.space == pytest.approx([0.0014, -0.052, -0.81], abs=0.006)
    damped = trade([strip(12)], Steps(1e-3, "MuJoCo", "discrete"))[0]
    assert 100 * damped.numerical == pytest.approx([2.15, 13.2, 32.9], abs=0.06)
    for engine, setting, figure in (("exudyn", "TrapezoidalIndex2", 0.463e-3), ("dart", "", 0.026e-3)):
        file = strip(12).simulated(1e-3, engine, setting)
        assert file.step_for(3, 0.01, damping=engine == "dart") == pytest.approx(figure, rel=0.02)
    assert largest_step(strip(12).simulated(1e-3, "mujoco"), 1, 0.01) == pytest.approx(168.2e-6 / 2, rel=1e-3)


def test_two_milliseconds_of_a_cable():
    steel = Beam(
        length=1.0, width=0.04, thickness=0.008, youngs_modulus=210e9, density=7850.0, supports=("clamped", "free")
    )
    run = SegmentModel(steel, 20).rigid_chain().simulated(2e-3, "MuJoCo")
    assert (run.omega_max * 2e-3, run.omega_max * run.limit) == pytest.approx((65.5, 2.0), rel=1e-3)
    assert (run.substeps, run.stable) == (33, False)
    modes = SegmentModel(steel, 20).rigid_chain(damping=0.01).simulated(2e-3, "mujoco", "discrete").modes
    assert (modes.hz[2], modes.zeta[2], modes.zeta[0]) == pytest.approx((68.14, 0.606, 0.0519), rel=1e-3)
    assert (modes.file_hz[2], modes.file_zeta[2]) == pytest.approx((115.47, 0.1755), rel=1e-3)


def test_hundred_links_about_three_axes_with_dashpots_of_their_own():
    """Of 300 unknowns the poles of A, of a floating chain and of an axis alone are those of the whole."""
    chain = strip(100, 0.01, in_space=True)
    file = chain.simulated(2e-5, "mujoco")
    uneven = file.damping * np.linspace(1.0, 1.7, 300)
    whole = stepped(file.mass, uneven, file.stiffness, 2e-5, A)
    plane = [slice(100), slice(100)]
    part = stepped(file.mass[*plane], uneven[*plane], file.stiffness[*plane], 2e-5, A)
    for mode in range(3):
        same = int(abs(whole.modes.hz - part.modes.hz[mode]).argmin())
        assert whole.modes.hz[same] == pytest.approx(part.modes.hz[mode], rel=1e-9)
        assert whole.modes.zeta[same] == pytest.approx(part.modes.zeta[mode], rel=1e-8)
    assert whole.limit <= part.limit
    floating = SegmentModel(replace(STRIP, supports=("free", "free")), 9).rigid_chain(damping=0.01)
    modes = floating.simulated(1e-4, "mujoco").modes
    assert modes.file_hz[:2] == pytest.approx(0.0, abs=1e-9)
    assert modes.file_hz[2] / sqrt(1 - 0.01**2) == pytest.approx(floating.frequencies_hz()[0], rel=1e-9)
    assert modes.file_zeta[2] == pytest.approx(0.01, rel=1e-9)


def test_every_row_is_found_or_refused_by_its_reason():
    for row in INTEGRATORS:
        if row.scheme:
            assert scheme_of(row.engine.upper(), row.setting.lower()) is row.scheme
        else:
            with pytest.raises(InputError, match=row.remark.split(",")[0]):
                scheme_of(row.engine, row.setting)
    for wrong in (("mujocco", ""), ("mujoco", "Eular")):
        with pytest.raises(InputError, match="did you mean"):
            scheme_of(*wrong)
    with pytest.raises(InputError, match="stiffness"):
        assert stepped(np.eye(2), np.zeros((2, 2)), -np.eye(2), 1.0, A).limit
