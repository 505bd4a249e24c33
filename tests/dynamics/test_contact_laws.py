"""Contact under every law, kinematics and damping: sizes, reactions, limits of stiction, impacts, drives by ticks."""

import numpy as np
import pytest
from msgspec.structs import replace
from reference.dense import Elements
from reference.slider import driven, hermite_modes, smooth
from scipy.integrate import solve_ivp

from verify import Beam, Contact, Excitation, Foot, Keep, PointForce, PrescribedSlider, Slider, simulate
from verify.contact.state import LANDS
from verify.problem.cross_section import Section

STRIP = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
HERTZ = 4276.0
FORCES = (PointForce(position=0.0116, amplitude=1.0), PointForce(position=0.4827, amplitude=1.1, phase_deg=83.0))
STEEL = Beam(
    length=0.5, width=0.02, thickness=0.002, youngs_modulus=206e9, density=7850.0, supports=("clamped", "free")
)


@pytest.mark.parametrize("kinematics", ["tangential", "following"])
@pytest.mark.parametrize("law", [{"law": "coulomb"}, {"law": "coulomb", "mu_static": 3.7}, {"law": "tanh"}])
def test_friction_of_a_clamped_mass_creates_no_energy_in_steps_of_an_eighth_of_a_period(law, kinematics):
    """100 g under 20.98 N and mu = 3 on 400 segments; friction once put 3.6 times the work of the drive into them."""
    forces = (FORCES[0], replace(FORCES[1], position=0.4884, amplitude=1.0, phase_deg=90.0))
    slider = Slider(mass=0.1, mu=3.0, preload=20.0, normal="massless", kinematics=kinematics, **law)
    given = {"count": 400, "slider": slider, "step": 1 / (8 * HERTZ), "keep": Keep(samples=9)}
    motion = simulate(STRIP, Excitation(forces, HERTZ, soft_start_periods=2.0), 3e-3, **given)
    energy = motion.energy
    assert energy.created < 5e-4 * energy.drive_work
    assert (np.cumsum(motion.friction_loss) >= 0.0).all()
    assert 0.01 < energy.friction_loss / energy.drive_work < 0.2
    assert energy.friction_on_beam + energy.slider <= 1e-12 * energy.drive_work
    assert abs(energy.residual) < 0.01 * energy.drive_work


@pytest.mark.parametrize("damping", [{"modal_damping": 0.05}, {"modal_damping": 0.012}])
@pytest.mark.parametrize("position", [0.21, 0.35])
def test_the_coupling_size_on_a_stepped_damped_beam_is_that_of_dense_elements(damping, position):
    """Mu N (h/2)^2 omega |slope by a unit couple| over (h/2) omega |slope by the drive|; m omega^2 |G|."""
    sections = (Section(length=0.14, thickness=0.001), Section(length=0.15, thickness=0.002),
                Section(length=0.21, thickness=0.001))  # fmt: skip
    beam, slider = replace(STRIP, section=sections), Slider(mass=2e-3, mu=0.3, position=position, coupling="one-way")
    given = {"model": "fem", "count": 100, "start": "steady", "keep": Keep(samples=2), **damping}
    found = simulate(beam, Excitation(FORCES, HERTZ), 1e-4, slider=slider, **given).coupling
    dense = Elements(beam, np.linspace(0.0, 0.5, 401))
    node, half = int(np.argmin(abs(dense.nodes - position))), 0.001 if position == 0.21 else 0.0005
    loads = dense.row(position, 0), dense.row(position, 1), dense.load(FORCES)
    lifted, turned, drive = (dense.harmonic(load, HERTZ, damping["modal_damping"]) for load in loads)
    expected = 0.3 * 2e-3 * 9.81 * half * abs(turned[2 * node + 1]) / abs(drive[2 * node + 1])
    assert found.friction_size == pytest.approx(expected, rel=0.01)
    assert found.normal_size == pytest.approx(2e-3 * (2 * np.pi * HERTZ) ** 2 * abs(lifted[2 * node]), rel=0.01)


@pytest.mark.parametrize("damping", [0.0, 0.03])
@pytest.mark.parametrize("kinematics", ["tangential", "following"])
@pytest.mark.parametrize("law", [{"law": "coulomb"}, {"law": "coulomb", "mu_static": 0.16}, {"slope": 1e4}])
def test_a_mass_that_sticks_has_the_forces_of_one_fixed_to_the_beam(law, kinematics, damping):
    """N = m (g + w_tt) and F = m dv/dt of six modes with an added mass; the following point bears N w' in F as well."""
    slider = Slider(mass=0.1, mu=0.1 if kinematics == "following" else 0.05, position=0.4, kinematics=kinematics, **law)
    modes = hermite_modes(STEEL, 8)
    own, push, there, lean = modes.own[:6], modes.shape(0.3, 0)[:6], modes.shape(0.4, 0)[:6], modes.shape(0.4, 1)[:6]
    whole = np.linalg.inv(np.eye(6) + 0.1 * np.outer(there, there))

    def forces(amplitude):
        def gained(t, y):
            load = amplitude * smooth(37.0 * t) * np.cos(2 * np.pi * 37.0 * t) * push - 0.981 * there
            return whole @ (load - own**2 * y[:6] - 2 * damping * own * y[6:])

        sag, times = np.r_[-0.981 * there / own**2, np.zeros(6)], np.linspace(0.0, 0.2, 401)
        ended = solve_ivp(lambda t, y: np.r_[y[6:], gained(t, y)], (0.0, 0.2), sag, t_eval=times, rtol=1e-8, atol=1e-11)
        q, rates, gains = (
            ended.y[:6].T,
            ended.y[6:].T,
            np.array([gained(*both) for both in zip(times, ended.y.T, strict=True)]),
        )
        normal, turning = 0.981 + 0.1 * gains @ there, 0.1 * (0.001 * gains @ lean - (rates @ there) * (rates @ lean))
        if kinematics == "following":
            return normal, normal * (q @ lean) - 0.1 * 0.001 * gains @ lean
        return normal, (normal - 0.981) * (q @ lean) - turning

    for amplitude in (0.2, 0.0):
        normal, friction = forces(amplitude)
        given = {"slider": slider, "model": "fem", "count": 8, "modal_damping": damping, "keep": Keep(samples=401)}
        force = PointForce(position=0.3, amplitude=amplitude)
        motion = simulate(STEEL, Excitation(force, 37.0, soft_start_periods=1.0), 0.2, **given)
        assert motion.normal_force == pytest.approx(normal, abs=2e-3)
        assert motion.largest_friction == pytest.approx(abs(friction).max(), rel=0.025 if amplitude else 0.06, abs=1e-5)
        assert motion.energy.friction_loss >= -1e-15


FEET = {
    "point": {"contact": Contact(stiffness=3e5, damping=6.0)},
    "gives way": {"contact": Contact(stiffness=3e5, damping=6.0, tangential_stiffness=1.3e5)},
    "layer": {"contact": Contact(layer_stiffness=3e7, layer_tangential_stiffness=1.3e7, damping=6.0),
              "foot": (Foot(length=0.01, points=4),)},
    "two feet": {"contact": Contact(stiffness=3e5, damping=6.0, tangential_stiffness=1.3e5),
                 "foot": (Foot(offset=-0.02), Foot(offset=0.015, face="lower"))},
    "hard": {"contact": Contact(restitution=0.3)},
}  # fmt: skip


@pytest.mark.parametrize(("feet", "coupling"), [(f, c) for f in FEET for c in ("one-way", "two-way")][:-1])
def test_feet_stay_up_to_the_static_limit_and_slide_under_the_kinetic_one(feet, coupling):
    """A pull on a slider at rest: below mu_s N = 1 N it stays in equilibrium, beyond it slides under mu N = 0.4 N."""
    beam = replace(STRIP, length=0.2, thickness=0.004)
    still, own = (
        PointForce(position=0.03, amplitude=0.0),
        {"mass": 0.05, "gravity": 0.0, "preload": 2.0, "position": 0.13},
    )
    for pull, runs in ((0.97, False), (1.03, True)):
        own |= {"external_force": pull, **FEET[feet]}
        slider = Slider(mu=0.2, mu_static=0.5, law="coulomb", coupling=coupling, **own)
        given = {"count": 30, "start": "rest", "modal_damping": 0.1, "keep": Keep(samples=17)}
        run = simulate(beam, Excitation(still, HERTZ), 4e-3, slider=slider, **given)
        if runs:
            assert np.diff(run.speed[[-3, -1]])[0] == pytest.approx((pull - 0.4) / 0.05 * 5e-4, rel=0.02)
            assert run.friction[9:] == pytest.approx(np.full(8, -0.4), rel=0.01)
            assert run.stick_fraction[9:].max() < 1e-12
        else:
            assert run.friction[1:] == pytest.approx(np.full(16, -pull), rel=1e-4)
            assert abs(run.displacement) < 1e-10
            assert run.stick_fraction[1:].min() > 1.0 - 1e-12


AT_REST = {
    "point": (Foot(),),
    "four points": (Foot(length=0.06, points=4),),
    "level": (Foot(length=0.06, points=4, pitches=False),),
    "both faces": (Foot(length=0.03, points=3, offset=-0.05), Foot(offset=0.04, face="lower")),
    "between": (Foot(length=0.06, points=3, mirrored=True),),
}


@pytest.mark.parametrize("feet", AT_REST)
@pytest.mark.parametrize(("supports", "model"), [("clamped free", "fem"), ("pinned guided", "segment"),
                                                 ("clamped pinned", "analytic")])  # fmt: skip
def test_nothing_moves_without_a_drive(feet, supports, model):
    """A carriage of 2 kg on a strip that sags under it, pulled within its limits; tanh friction creeps under a pull."""
    beam = Beam(length=1.0, width=0.04, thickness=0.008, youngs_modulus=210e9, density=7850.0, loss_factor=0.01,
                supports=tuple(supports.split()))  # fmt: skip
    own = {"mass": 2.0, "mu": 0.2, "position": 0.8, "preload": 30.0, "foot": AT_REST[feet]}
    own["gravity"] = 0.0 if feet == "between" else 9.81
    contacts = Contact(stiffness=1e6, damping=20.0), Contact(stiffness=1e6, tangential_stiffness=7e5)
    for law, contact, pull in (({"law": "tanh"}, 0, 0.0), ({"law": "coulomb"}, 0, -3.1),
                               ({"law": "coulomb", "mu_static": 0.5}, 1, 7.3)):  # fmt: skip
        slider = Slider(contact=contacts[contact], external_force=pull, **law, **own)
        still = Excitation(PointForce(position=0.5, amplitude=0.0), 50.0)
        given = {"model": model, "count": None if model == "analytic" else 12, "keep": Keep(samples=26)}
        run = simulate(beam, still, 0.05, slider=slider, start="rest", **given)
        assert run.normal_force == pytest.approx(np.full(26, run.normal_force[0]), rel=1e-6)
        assert run.friction[1:] == pytest.approx(np.full(25, -pull), abs=2e-3)
        assert abs(run.travelled).max() < 1e-10
        assert np.ptp(run.pitch, axis=0).max() < 1e-7


@pytest.mark.parametrize(
    ("points", "mu_static", "micrometres"), [(3, None, -52.035), (3, 0.4, -90.11), (4, None, -45.95), (4, 0.4, -98.84)]
)
def test_points_of_a_foot_hold_together_up_to_their_static_limits(points, mu_static, micrometres):
    """Displacements by `reference.contact.ran` at creeps of 1e-5 and 2e-6 m/s, extrapolated to none: to 0.02 um.

    Static friction of 0.4 N once let go at 0.1 N. Steps of 1/800 and 1/1600 of a period; where static friction makes
    the default step too long, its doubling shows it.
    """
    beam = Beam(length=0.31, width=0.017, thickness=0.0023, youngs_modulus=113e9, density=4470.0)
    forces = PointForce(position=0.05, amplitude=18.0), PointForce(position=0.23, amplitude=12.0, phase_deg=77.0)
    slider = Slider(mass=0.02, mu=0.1, mu_static=mu_static, law="coulomb", position=0.117, preload=60.0,
                    contact=Contact(stiffness=1.5e6, damping=8.0), foot=(Foot(length=0.03, points=points),))  # fmt: skip
    drive = Excitation(forces, 700.0, soft_start_periods=1.0)
    given = {"model": "fem", "count": 4, "slider": slider, "modal_damping": 0.02, "keep": Keep(samples=3)}
    for steps, band in ((800, 3e-3), (1600, 1e-3)):
        step = 1.0 / (700.0 * steps)
        motion = simulate(beam, drive, 8.0 / 700.0, start="rest", step=step, **given)
        assert 1e6 * motion.displacement == pytest.approx(micrometres, rel=band)
        assert motion.statistics.unconverged == 0
    coarse = simulate(beam, drive, 8.0 / 700.0, start="rest", **given)
    error = abs(1e6 * coarse.displacement / micrometres - 1.0)
    assert error < (0.02 if mu_static is None else 2.0 * coarse.statistics.step_change)


@pytest.mark.parametrize("restitution", [0.0, 0.4])
def test_an_impact_on_free_modes_from_rest_keeps_momentum_and_restitution(restitution):
    """Flights are parabolas; the surface is that of the modes by DOP853."""
    modes, load, mass = hermite_modes(STRIP, 5), 0.05, 2.3e-3
    slider = Slider(mass=mass, mu=0.2, gravity=0.0, preload=load, position=0.23, coupling="one-way",
                    contact=Contact(restitution=restitution))  # fmt: skip
    given = {"model": "fem", "count": 5, "start": "rest", "modal_damping": 0.02, "keep": Keep(samples=2001)}
    drive, held = Excitation(FORCES, HERTZ, soft_start_periods=1.0), PrescribedSlider(slider, 0.0, fixed_position=True)
    run = simulate(STRIP, drive, 2e-3, slider=held, step=1e-6, **given)
    fall, t, z = load / mass, run.times, run.height[:, 0]
    apart = np.diff(np.r_[0.0, run.events[:, 0], 2e-3])
    lands = [
        e[0] for e, a, b in zip(run.events, apart[:-1], apart[1:], strict=True) if e[1] == LANDS and min(a, b) > 6e-6
    ]
    states = driven(modes, FORCES, HERTZ, lands, damping=0.02, growth=lambda t: smooth(t * HERTZ), breaks=[1 / HERTZ])
    assert len(lands) >= 3
    for when, state in zip(lands, states, strict=True):
        i = int(np.searchsorted(t, when))
        q, rates = np.split(state, 2)
        shape = modes.shape(0.23 + 0.0005 * (modes.shape(0.23, 1) @ q), 0)
        before = (z[i - 1] - z[i - 3]) / 2e-6 - fall * (when - t[i - 2])
        after = (z[i + 2] - z[i]) / 2e-6 + fall * (t[i + 1] - when) if restitution else shape @ rates
        assert z[i - 1] + (before + 0.5 * fall * (when - t[i - 1])) * (when - t[i - 1]) == pytest.approx(
            shape @ q, abs=1e-11
        )
        assert after - shape @ rates == pytest.approx(-restitution * (before - shape @ rates), rel=2e-3, abs=1e-7)
        impulse = mass * (after - before)
        assert run.normal_force[i] * 1e-6 == pytest.approx(impulse, rel=5e-3 if restitution else 0.1)
    assert run.energy.residual == pytest.approx(0.0, abs=1e-9 * run.energy.contact_loss)


@pytest.mark.parametrize(("coupling", "steps"), [(None, ()), ("one-way", (40, 80, 160)), ("two-way", (40, 80, 160))])
def test_a_controller_sets_frequency_amplitude_and_phase_at_every_tick(coupling, steps):
    """Runs in pieces between ticks, each under its own drive by what the one before has measured, against DOP853."""
    modes, tick, half, n = hermite_modes(STRIP, 4), 3.7e-4, 0.0005, 8
    own, push, seen = modes.own, modes.shape(0.037, 0), modes.shape(0.123, 0)
    slider = Slider(mass=0.04, mu=0.3, slope=300.0, position=0.19, normal="massless", coupling=coupling or "one-way")

    def drive(number, measured):
        return 1.3 - 2e4 * measured, 1310.0 + 90.0 * number, 17.0 - 60.0 * number

    def rates(t, y, force, hertz, turn):
        q, qd, x, v = y[:n], y[n : 2 * n], y[-2], y[-1]
        at = x + half * (modes.shape(x, 1) @ q)
        lean = modes.shape(at, 1) @ q
        along = (lean * modes.shape(at, 0) - half * modes.shape(at, 1)) / np.hypot(1.0, lean)
        friction = -0.3 * 0.04 * 9.81 * np.tanh(300.0 * (v - along @ qd)) if coupling else 0.0
        load = (
            force * np.cos(2 * np.pi * hertz * t + np.deg2rad(turn)) * push - (coupling == "two-way") * friction * along
        )
        return np.r_[qd, load - 0.006 * own * qd - own**2 * q, v, friction / 0.04]

    y, expected = np.r_[np.zeros(2 * n), 0.19, 0.0], []
    for number in range(5):
        span = number * tick, (number + 1) * tick
        args = drive(number, seen @ y[:n])
        y = solve_ivp(rates, span, y, args=args, method="DOP853", rtol=1e-11, atol=1e-16).y[:, -1]
        expected.append(seen @ y[:n])
    errors = []
    for count in steps or (0,):
        run, found = None, []
        more = {"slider": slider, "step": tick / count} if count else {}
        more |= {"model": "fem", "count": 4, "modal_damping": 0.003, "keep": Keep(at=0.123, samples=2)}
        for number in range(5):
            force, hertz, turn = drive(number, run.deflection[-1, 0] if run else 0.0)
            excitation = Excitation(PointForce(position=0.037, amplitude=force, phase_deg=turn), hertz)
            run = simulate(STRIP, excitation, tick, start=run, **more)
            found.append(run.deflection[-1, 0])
        errors.append(
            [
                abs(np.array(found) / expected - 1.0).max(),
                abs(run.travelled[-1] / (y[-2] - 0.19) - 1.0) if count else 0.0,
            ]
        )
    errors = np.array(errors)
    assert errors[:, 1].max() < 1e-7
    assert errors[-1, 0] < (5e-8 if coupling == "two-way" else 1e-10)
    assert coupling != "two-way" or np.log2(errors[:-1, 0] / errors[1:, 0]) == pytest.approx(2.0, abs=0.1)
