"""Faults in sliders, friction, forcing and motion in time. Each takes a monkeypatch and plants itself where the figure comes from."""

import numpy as np
from faults.modes import link_inertia_left_out
from msgspec import structs

from verify.chain import confirmed
from verify.chain import ride as chain_ride
from verify.elements import in_time as fem_motion
from verify.exact import harmonic as analytic_harmonic
from verify.motion import (
    carried,
    contact,
    forcing,
    friction_kernels,
    pure_wave,
    records,
    request,
    rigid_surface,
    simulate,
)
from verify.motion import kernels as contact_kernels
from verify.quantities import simulated as motions
from verify.segments import in_time as segment_motion
from verify.segments import linear as segment_model


def slider_on_a_chain_that_does_not_draw_in(patch):
    true = chain_ride._surface

    def still_along(*given):
        local, along, edges = true(*given)
        return local, 0.0 * along, edges

    patch.setattr(chain_ride, "_surface", still_along)


def slider_on_links_that_stretch_a_tenth_less(patch):
    true = confirmed.simulate_elastic
    patch.setattr(
        confirmed,
        "simulate_elastic",
        lambda system, stiffness, times, **more: true(system, 1.1 * stiffness, times, **more),
    )


def slider_on_a_chain_that_feels_the_mid_line(patch):
    true = chain_ride.law_of
    patch.setattr(chain_ride, "law_of", lambda *given: law_with(true(*given), half=1e-9))


def slider_on_a_chain_under_another_gravity(patch):
    true = chain_ride.law_of
    patch.setattr(
        chain_ride,
        "law_of",
        lambda slider, beam: true(structs.replace(slider, gravity=9.80665), beam),
    )


def friction_booked_at_a_thousandth_less(patch):
    true = chain_ride._over
    patch.setattr(chain_ride, "_over", lambda times, values: true(times, 0.999 * values))


def surface_lever_forgotten(patch):
    """The slider feels the mid-line, whose first-order speed is across."""
    for module in (carried, pure_wave):
        true = module.law_of
        patch.setattr(module, "law_of", lambda *given, true=true: law_with(true(*given), half=1e-9))


def law_with(law, **factors):
    """A law with fields times factors; a field that it does not have is an error."""
    return law._replace(**{name: getattr(law, name) * factor for name, factor in factors.items()})


def surface_lever_doubled(patch):
    true = pure_wave.law_of
    patch.setattr(pure_wave, "law_of", lambda *given: law_with(true(*given), half=2.0))


def friction_that_pushes(patch):
    """What friction adds to the speed in every step, with its sign turned round."""
    true, true_belt = contact_kernels.slide, friction_kernels.slide_on_belt

    def slide(n_steps, dt, surface, rider, *given):
        for _ in range(n_steps):
            before = rider.motion[records.V]
            why = true(1, dt, surface, rider, *given)
            if why != records.DONE:
                return why
            rider.motion[records.V] = 2 * before - rider.motion[records.V]
        return records.DONE

    def slide_on_belt(n_steps, dt, law, belt, stiffness, pull, state, events):
        for _ in range(n_steps):
            before = state[1]
            true_belt(1, dt, law, belt, stiffness, pull, state, events)
            state[1] = 2 * (before + pull * dt) - state[1]
        return 0

    patch.setattr(contact_kernels, "slide", slide)
    patch.setattr(friction_kernels, "slide_on_belt", slide_on_belt)


def one_way_for_two_way(patch):
    true = carried.coupling_of
    patch.setattr(carried, "coupling_of", lambda *given: structs.replace(true(*given), two_way=False))


def two_way_for_one_way(patch):
    true = carried.coupling_of
    patch.setattr(carried, "coupling_of", lambda *given: structs.replace(true(*given), two_way=True))


def held_slider_without_inertia(patch):
    """Nor weight: only friction is given back to the beam."""
    true = carried.law_of
    patch.setattr(carried, "law_of", lambda *given: true(*given)._replace(held=False))


def loss_of_the_beam_booked_at_a_thousandth_less(patch):
    true = carried._ledger

    def short(*given):
        books = true(*given)
        missed = 1e-3 * books.damped
        return structs.replace(books, damped=books.damped - missed, residual=books.residual + missed)

    patch.setattr(carried, "_ledger", short)


def weight_of_another_load(patch):
    true = carried.law_of
    patch.setattr(carried, "law_of", lambda *given: law_with(true(*given), load=1.001))


def friction_of_a_millionth_more(patch):
    true = carried.law_of
    patch.setattr(carried, "law_of", lambda *given: law_with(true(*given), kinetic=1.000001))


def steady_start_without_the_mass(patch):
    patch.setattr(carried, "carried_along", lambda basis, *given: (np.zeros(len(basis.omegas)),) * 2)


def start_without_the_sag(patch):
    patch.setattr(carried, "weighed_down", lambda basis, *given: np.zeros(len(basis.omegas)))


def mass_that_pulls_the_beam_along(patch):
    """Its inertia with the sign of a spring."""
    true = motions.slider_of
    patch.setattr(motions, "slider_of", lambda *given: _with_mass(true(*given), -1.0))


def _with_mass(slider, factor):
    """A slider that its own checks would refuse."""
    other = structs.replace(slider)
    structs.force_setattr(other, "mass", factor * slider.mass)
    return other


def friction_at_the_mid_line(patch):
    """The moment arm of friction is a whole thickness."""
    true = contact.coupling_of
    patch.setattr(
        contact,
        "coupling_of",
        lambda slider, beam, *given: true(slider, structs.replace(beam, thickness=2 * beam.thickness), *given),
    )


def friction_on_an_endless_beam(patch):
    """No echo from its ends, and so no resonance."""
    true = contact.coupling_of

    def endless(slider, beam, frequency_hz, speed, receptance, turning):
        k = np.sqrt(2 * np.pi * frequency_hz / beam.wave_constant)
        return true(slider, beam, frequency_hz, speed, receptance, (1 - 1j) / (4 * beam.bending_stiffness * k))

    patch.setattr(contact, "coupling_of", endless)


def driving_point_read_a_node_off(patch):
    """The response to a unit force is that of one a twentieth of a millimetre away."""
    true = motions.PointForce
    patch.setattr(motions, "PointForce", lambda position: true(position=position + 5e-5))


def half_of_the_modes_kept(patch):
    true = simulate.basis_of
    patch.setattr(
        simulate, "basis_of", lambda beam, model, count, modes, line: true(beam, model, count, modes // 2, line)
    )


def raw_line_for_the_spline(patch):
    true = simulate.basis_of
    patch.setattr(
        simulate,
        "basis_of",
        lambda beam, model, *given: true(beam, model, *given[:2], "raw" if model == "segment" else "spline"),
    )


def step_load_for_the_soft_start(patch):
    true = request.laid_out
    patch.setattr(request, "laid_out", lambda duration, grown, *given: true(duration, (), *given))


def load_in_time_on_the_next_joint(patch):
    true = segment_motion.joint_weights
    patch.setattr(segment_motion, "joint_weights", lambda *given: np.roll(true(*given), 1))


def load_in_time_on_the_next_node(patch):
    true = fem_motion._unit_force

    def moved(*given):
        nodes, *loads = true(*given)
        return nodes + 1, *loads

    patch.setattr(fem_motion, "_unit_force", moved)


def link_inertia_left_out_in_time(patch):
    link_inertia_left_out(patch)
    patch.setattr(segment_motion, "_mass_share", np.ones_like)


def drift_of_second_order_dropped(patch):
    """What rises and falls carries a point that follows it: 219 of 220 parts of the drift are gone."""
    true = pure_wave.law_of
    patch.setattr(pure_wave, "law_of", lambda *given: true(*given)._replace(following=True))


def following_taken_for_tangential(patch):
    true = pure_wave.law_of
    patch.setattr(pure_wave, "law_of", lambda *given: true(*given)._replace(following=False))


def standing_wave_for_a_travelling_one(patch):
    true = pure_wave.wave_stage

    def standing(*given):
        stage = true(*given)
        shapes = stage.drive_shapes
        return structs.replace(stage, drive_shapes=lambda x, d: shapes(x, d) * np.array([[1.0], [0.0]]))

    patch.setattr(pure_wave, "wave_stage", standing)


def phases_in_time_of_the_wrong_sign(patch):
    for module in (analytic_harmonic, segment_model, forcing):
        true = module.phasor
        patch.setattr(module, "phasor", lambda force, true=true: true(force).conjugate())


def surface_seen_half_a_step_late(patch):
    """Of first order in the step."""
    true = contact_kernels.slide

    def slide(n_steps, dt, surface, *given):
        late = surface.drive._replace(origin=surface.drive.origin - 0.5 * dt)
        return true(n_steps, dt, surface._replace(drive=late), *given)

    patch.setattr(contact_kernels, "slide", slide)


def friction_under_another_gravity(patch):
    """9.80665 m/s^2."""
    true = rigid_surface._law
    patch.setattr(
        rigid_surface, "_law", lambda coulomb, kinetic, *given: true(coulomb, kinetic * 9.80665 / 9.81, *given)
    )


def static_friction_for_kinetic(patch):
    true = rigid_surface._law
    patch.setattr(
        rigid_surface,
        "_law",
        lambda coulomb, kinetic, static, slope: true(coulomb, 0.9 * kinetic + 0.1 * static, static, slope),
    )


def friction_of_half_the_slope(patch):
    true = rigid_surface._law
    patch.setattr(rigid_surface, "_law", lambda coulomb, b, static, slope: true(coulomb, b, static, 0.5 * slope))


def means_over_a_thousandth_less_time(patch):
    true = carried.of_all_steps
    patch.setattr(carried, "of_all_steps", lambda motion, mass, seconds: true(motion, mass, 0.999 * seconds))


def phases_left_as_they_are_where_they_were_to_turn(patch):
    patch.setattr(motions, "turned", tuple)


def samples_for_all_steps(patch):
    """A run's two samples, its start and its end, stand for what all its steps have added up."""
    true = carried.Motion

    def told(**given):
        ends = {"mean_friction": given["friction"].mean(), "mean_surface_speed": given["surface_speed"].mean()}
        return true(**given | ends | {"largest_friction": abs(given["friction"]).max()})

    patch.setattr(carried, "Motion", told)


FAULTS = {
    "paper-slider": {
        slider_on_a_chain_that_does_not_draw_in: {"chain-slider", "chain-slider-on-links-that-stretch"},
        slider_on_links_that_stretch_a_tenth_less: {"chain-slider-on-links-that-stretch"},
        slider_on_a_chain_that_feels_the_mid_line: {"chain-slider", "chain-slider-in-the-limit"},
        slider_on_a_chain_under_another_gravity: {"chain-slider-in-the-limit", "chain-slider-saturates"},
        friction_booked_at_a_thousandth_less: {"chain-slider-books", "chain-slider-books-following"},
        means_over_a_thousandth_less_time: {"slider-mean-friction", "slider-mean-surface-speed"},
        phases_left_as_they_are_where_they_were_to_turn: {"slider-turned-round"},
        samples_for_all_steps: {"slider-largest-friction", "slider-mean-friction", "slider-mean-surface-speed"},
        surface_lever_forgotten: {
            "terminal-speed-steep",
            "slider-elements",
            "slider-segments",
            "slider-against-the-wave",
            "slider-reversed",
            "slider-steady",
            "slider-felt",
        },
        surface_lever_doubled: {"terminal-speed-flat", "terminal-speed-quarter", "terminal-speed-following"},
        friction_that_pushes: {
            "free-decay",
            "creep",
            "belt-stick-time",
            "belt-slip-time",
            "coulomb-decrement",
            "slider-segments",
            "slider-elements",
            "slider-steady",
        },
        friction_under_another_gravity: {
            "free-decay",
            "creep",
            "coulomb-decrement",
            "belt-stick-time",
            "belt-slip-time",
        },
        static_friction_for_kinetic: {"belt-stick-time", "belt-slip-time"},
        friction_of_half_the_slope: {"free-decay", "creep"},
        one_way_for_two_way: {"slider-felt", "held-from-rest"},
        held_slider_without_inertia: {
            "held-steady-segments",
            "held-steady-elements",
            "held-from-rest",
        },
        steady_start_without_the_mass: {"held-steady-segments", "held-steady-elements"},
        start_without_the_sag: {"held-steady-segments", "held-steady-elements"},
        mass_that_pulls_the_beam_along: {"loaded-exact", "loaded-segments", "loaded-elements"},
        friction_at_the_mid_line: {"friction-size", "friction-size-near-a-resonance"},
        friction_on_an_endless_beam: {"friction-size", "friction-size-near-a-resonance"},
        driving_point_read_a_node_off: {"normal-size", "loaded-exact"},
        half_of_the_modes_kept: {"slider-at-once", "slider-step-steep"},
        raw_line_for_the_spline: {"slider-segments", "slider-order-segment", "slider-felt", "beam-segments"},
        step_load_for_the_soft_start: {
            "slider-segments",
            "slider-elements",
            "slider-order-segment",
            "slider-order-fem",
            "beam-segments",
            "beam-elements",
            "slider-felt",
        },
        load_in_time_on_the_next_joint: {"slider-segments", "slider-order-segment", "slider-felt", "beam-segments"},
        load_in_time_on_the_next_node: {"slider-elements", "slider-order-fem", "beam-elements"},
        link_inertia_left_out_in_time: {
            "slider-segments",
            "slider-order-segment",
            "slider-steady",
            "beam-segments",
            "slider-felt",
        },
        drift_of_second_order_dropped: {"terminal-speed-flat", "terminal-speed-quarter"},
        following_taken_for_tangential: {"terminal-speed-following"},
        standing_wave_for_a_travelling_one: {
            "terminal-speed-flat",
            "terminal-speed-quarter",
            "terminal-speed-steep",
            "terminal-speed-following",
        },
        phases_in_time_of_the_wrong_sign: {
            "slider-against-the-wave",
            "slider-reversed",
            "slider-steady",
            "slider-segments",
            "beam-segments",
        },
        surface_seen_half_a_step_late: {"slider-order-step"},
    },
    "heavy-slider": {
        one_way_for_two_way: {"books-contact", "books-way"},
        held_slider_without_inertia: {"books-reaction", "books-way"},
        two_way_for_one_way: {"books-contact-one-way"},
        friction_of_a_millionth_more: {"coulomb-slides"},
        loss_of_the_beam_booked_at_a_thousandth_less: {
            "books-damped",
            "books-close",
            "books-close-coulomb",
            "books-close-one-way",
            "books-close-held",
        },
    },
    "moving-load": {
        held_slider_without_inertia: {
            "largest-deflection",
            "largest-deflection-segments",
            "largest-deflection-elements",
            "on-the-way",
        },
        weight_of_another_load: {"largest-deflection", "on-the-way"},
    },
}
"""By scene: each fault with gates that it turns red."""
