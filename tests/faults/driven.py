"""Faults in driven fields, shapes, energies and loads at rest of any beam. Each takes a monkeypatch and plants itself."""

import numpy as np
from faults.modes import roots_of_a_beam_with_one_half_wave_too_many
from msgspec import structs

from verify.chain import bending, splitting
from verify.elements import linear as fem_beam
from verify.elements import mesh as element_mesh
from verify.elements import pencil as element_pencil
from verify.exact import buckling
from verify.exact import driven as exact_driven
from verify.exact import harmonic as exact_harmonic
from verify.exact import modes as exact_modes
from verify.models import eigen, fields, time_basis, underfoot
from verify.motion import energy, forcing, free_vibration, surface
from verify.segments import buckling as chain_buckling
from verify.segments import carried as chain_carried
from verify.segments import linear as segment_model
from verify.segments import walls as chain_walls
from verify.waves import imposed, measures, operating_point, poles, series, unit_waves


def phases_of_the_wrong_sign(patch):
    for module in (exact_harmonic, exact_driven, fem_beam, segment_model, imposed, forcing):
        true = module.phasor
        patch.setattr(module, "phasor", lambda force, true=true: true(force).conjugate())


def second_and_further_forces_forgotten(patch):
    for module in (exact_harmonic, exact_driven, fem_beam, segment_model):
        if hasattr(module, "as_forces"):
            patch.setattr(module, "as_forces", lambda forces, true=module.as_forces: true(forces)[:1])


def receptances_of_a_thousandth_more(patch):
    true = unit_waves.unit_fields
    patch.setattr(unit_waves, "unit_fields", lambda *given: 1.001 * true(*given))


def surfaces_of_the_beams_own_section_everywhere(patch):
    patch.setattr(measures, "surface_distance_at", lambda beam, x: np.full(np.shape(x), beam.surface_distance))


def surfaces_of_the_next_section(patch):
    true = underfoot.piece_at
    patch.setattr(underfoot, "piece_at", lambda beam, x: (true(beam, x) + 1) % len(beam.pieces))


def displacements_held_at_one_place_alone(patch):
    true = fields.combined
    for module in (imposed, poles):
        patch.setattr(module, "combined", lambda parts: true(parts[:1]))


def losses_of_bending_twice_as_large(patch):
    """Of every model: what the real part says twice."""
    true_fem, true_chain = fem_beam.damped_stiffness, segment_model.damped
    patch.setattr(fem_beam, "damped_stiffness", lambda *given: (s := true_fem(*given)) + 1j * s.imag)
    patch.setattr(segment_model, "damped", lambda *given: (s := true_chain(*given)) + 1j * s.imag)


def ratios_of_a_tenth_more(patch):
    for module in (fem_beam, segment_model):
        true = module.damped_response

        def response(pencil, loads, omega2, stiffness, ratio, true=true):
            return true(pencil, loads, omega2, stiffness, 1.1 * ratio)

        patch.setattr(module, "damped_response", response)


def lever_and_reciprocal_pair_exchanged(patch):
    true, other = segment_model.joint_weights, {"lever": "reciprocal", "reciprocal": "lever"}
    patch.setattr(segment_model, "joint_weights", lambda chain, x, rule: true(chain, x, other[rule]))


def links_turned_by_a_thousandth_more(patch):
    true = segment_model.link_slopes
    patch.setattr(segment_model, "link_slopes", lambda *given: 1.001 * true(*given))


def gregorys_weights_a_thousandth_off(patch):
    first, *rest = chain_walls._CORRECTIONS["gregory"]
    patch.setitem(chain_walls._CORRECTIONS, "gregory", (1.001 * first, *rest))


def half_a_joint_at_the_wall_a_thousandth_off(patch):
    patch.setitem(chain_walls._CORRECTIONS, "half", tuple(1.001 * one for one in chain_walls._CORRECTIONS["half"]))


def cubics_of_elements_a_thousandth_too_long(patch):
    true = element_mesh.interpolate
    for module in (fem_beam, element_mesh):
        patch.setattr(module, "interpolate", lambda basis, nodal, x, d=0: true(basis, nodal, 0.999 * x, d))


def exact_shapes_from_the_other_end(patch):
    plain = exact_modes._shapes

    def mirrored(beam, modes, x, derivative, theory):
        return plain(beam, modes, beam.length - np.asarray(x), derivative, theory)

    patch.setattr(exact_modes, "_shapes", mirrored)


def shapes_of_twice_the_modal_mass(patch):
    plain = exact_modes._shapes
    patch.setattr(exact_modes, "_shapes", lambda *given: plain(*given) * 2**0.5)
    true = eigen.factored_quotient

    def heavier(pencil, vectors):
        values, scaled = true(pencil, vectors)
        return values, scaled * 2**0.5

    patch.setattr(eigen, "factored_quotient", heavier)


def slopes_for_deflections_of_exact_shapes(patch):
    plain = exact_modes.mode_shape
    patch.setattr(
        exact_modes,
        "mode_shape",
        lambda beam, mode, x, d=0, theory="euler-bernoulli": plain(beam, mode, x, 1 - d, theory),
    )


def columns_a_hundredth_too_strong(patch):
    exact, fem, chain = buckling.nth_root, element_pencil.buckling_ratio, chain_buckling.buckling_ratio
    patch.setattr(buckling, "nth_root", lambda *given: 1.01 * exact(*given))
    patch.setattr(element_pencil, "buckling_ratio", lambda *given: fem(*given) / 1.01)
    patch.setattr(chain_buckling, "buckling_ratio", lambda *given: chain(*given) / 1.01)


def joints_that_do_not_follow_the_load(patch):
    patch.setattr(chain_buckling, "_PASSES", 1)


def moment_at_the_tip_forgotten(patch):
    true = bending.LinkLoad
    patch.setattr(bending, "LinkLoad", lambda **given: true(**{**given, "moment": 0.0}))


def half_link_at_the_tip_rigid(patch):
    """Whose stiffness is read last, behind those of the joints."""
    true = bending._stiffness_at
    patch.setattr(bending, "_stiffness_at", lambda beam, x: np.append(true(beam, x)[:-1], np.inf))


def modes_damped_a_tenth_less(patch):
    true = forcing.modal
    for module in (forcing, free_vibration, surface):
        patch.setattr(module, "modal", lambda basis, forces, damping: true(basis, forces, 0.9 * damping))


def loads_halved_in_time(patch):
    true = forcing.phasor
    patch.setattr(forcing, "phasor", lambda force: 0.5 * true(force))


def works_without_their_second_half(patch):
    true = energy._integrals
    patch.setattr(energy, "_integrals", lambda *given: tuple(0.5 * one for one in true(*given)))


def shapes_let_go_without_their_speed(patch):
    true = free_vibration._told

    def still(basis, damping, points, times, q, rates, unread):
        return true(basis, damping, points, times, q, 0.0 * rates, unread)

    patch.setattr(free_vibration, "_told", still)


def shapes_let_go_a_thousandth_higher(patch):
    true = free_vibration._values
    patch.setattr(free_vibration, "_values", lambda *given: 1.001 * true(*given))


def bodies_let_go_without_their_turn(patch):
    patch.setattr(free_vibration, "_slopes", lambda name, given, known: 0.0 * known.turning)


def bodies_that_turn_with_the_line_through_the_joints(patch):
    true = time_basis.TimeBasis.body_turns
    patch.setattr(time_basis.TimeBasis, "body_turns", lambda basis: true(structs.replace(basis, turns=None)))


def rotary_inertia_of_no_share(patch):
    """What was let go is read off the line alone, and a body's turn is anything."""
    true = free_vibration._quadrature

    def without(basis, breaks):
        known = true(basis, breaks)
        n = len(known.x)
        return structs.replace(known, turning=known.turning[:0], weights=known.weights[:n], shapes=known.shapes[:, :n])

    patch.setattr(free_vibration, "_quadrature", without)


def limit_of_reflection_a_hundredth_looser(patch):
    true = operating_point.fastest
    patch.setattr(operating_point, "fastest", lambda land, f, phase, limit: true(land, f, phase, 1.01 * limit))


def sensitivities_of_forces_for_those_of_displacements(patch):
    patch.setattr(unit_waves, "held_units", lambda units, places, beam, f, x: units(places, f, x))


def wavenumber_of_the_beam_alone(patch):
    """Without what theory, tension and ground do to it."""
    patch.setattr(fields, "_running", lambda beam, omega, theory: complex((omega / beam.wave_constant) ** 0.5))


def waves_in_time_two_per_cent_short(patch):
    true = series.fitted_wavenumber
    patch.setattr(series, "fitted_wavenumber", lambda *given: 1.02 * true(*given))


def linear_flow_a_thousandth_more(patch):
    true = splitting.linear_states
    patch.setattr(splitting, "linear_states", lambda *given: 1.001 * true(*given))


def turn_of_a_clamps_spring_taken_for_that_of_its_joint(patch):
    true = chain_carried._added

    def added(beam, chain, *given):
        return structs.replace(true(beam, chain, *given), joint_inertias=chain.joint_inertias)

    patch.setattr(chain_carried, "_added", added)


def gates(text):
    """Their ids, as written."""
    return set(text.split())


FAULTS = {
    "chain": {linear_flow_a_thousandth_more: gates("small-force-linear")},
    "paper-slider": {
        loads_halved_in_time: gates("coarse-beam-elements coarse-beam-segments"),
        waves_in_time_two_per_cent_short: gates("reflection-in-time"),
    },
    "driven-cantilever": {
        phases_of_the_wrong_sign: gates(
            "exact-deflection exact-slope exact-curvature exact-beside-the-tip exact-undamped exact-slow surface-ellipse surface-ellipse-turning-back "
            "exact-slow-slope exact-slow-curvature exact-fast exact-imposed elements-deflection elements-slope "
            "elements-curvature elements-by-a-ratio elements-undamped elements-imposed links-deflection "
            "links-slope raw-joints segments-deflection segments-slope segments-curvature segments-with-dashpots "
            "segments-by-a-ratio segments-half-wall segments-imposed beam-elements beam-segments beam-exact "
            "beam-exact-undamped work-in damped kinetic elastic work-at-once damped-at-once"
        ),
        second_and_further_forces_forgotten: gates(
            "exact-deflection exact-slope exact-curvature exact-beside-the-tip exact-undamped exact-slow "
            "exact-slow-slope exact-slow-curvature exact-fast elements-deflection elements-slope "
            "elements-curvature elements-by-a-ratio elements-undamped links-deflection links-slope raw-joints "
            "segments-deflection segments-slope segments-curvature segments-with-dashpots segments-by-a-ratio "
            "segments-half-wall beam-exact beam-exact-undamped"
        ),
        receptances_of_a_thousandth_more: gates("exact-receptance elements-receptance segments-receptance"),
        displacements_held_at_one_place_alone: gates(
            "exact-imposed elements-imposed segments-imposed imposed-on-resonance"
        ),
        losses_of_bending_twice_as_large: gates(
            "elements-deflection elements-slope elements-curvature elements-imposed links-deflection links-slope "
            "raw-joints segments-deflection segments-slope segments-curvature segments-with-dashpots "
            "segments-half-wall segments-imposed"
        ),
        ratios_of_a_tenth_more: gates("elements-by-a-ratio segments-by-a-ratio"),
        lever_and_reciprocal_pair_exchanged: gates(
            "links-deflection links-slope raw-joints segments-deflection segments-slope segments-curvature "
            "segments-with-dashpots segments-by-a-ratio segments-half-wall segments-receptance segments-imposed"
        ),
        links_turned_by_a_thousandth_more: gates("links-slope"),
        gregorys_weights_a_thousandth_off: gates(
            "links-deflection links-slope raw-joints segments-deflection segments-slope segments-curvature "
            "segments-with-dashpots segments-by-a-ratio segments-receptance segments-imposed segments-shape "
            "segments-shape-slope links-buckling beam-segments damped kinetic work-at-once released-segments "
            "released-elastic bent-deflection bent-energy"
        ),
        half_a_joint_at_the_wall_a_thousandth_off: gates("segments-half-wall bent-shortening"),
        cubics_of_elements_a_thousandth_too_long: gates(
            "elements-deflection elements-slope elements-curvature elements-by-a-ratio elements-undamped "
            "elements-receptance elements-imposed elements-shape elements-shape-slope"
        ),
        exact_shapes_from_the_other_end: gates(
            "exact-shape-1 exact-shape-slope-1 exact-shape-4 exact-shape-slope-4 beam-exact beam-exact-undamped "
            "released-exact released-kinetic"
        ),
        shapes_of_twice_the_modal_mass: gates(
            "elements-by-a-ratio elements-receptance segments-by-a-ratio segments-receptance exact-shape-1 "
            "exact-shape-slope-1 exact-shape-4 exact-shape-slope-4 elements-shape elements-shape-slope "
            "segments-shape segments-shape-slope beam-elements beam-segments beam-exact beam-exact-undamped "
            "work-in damped kinetic elastic work-at-once damped-at-once released-kinetic released-elastic"
        ),
        slopes_for_deflections_of_exact_shapes: gates(
            "exact-shape-1 exact-shape-slope-1 exact-shape-4 exact-shape-slope-4"
        ),
        columns_a_hundredth_too_strong: gates("exact-buckling elements-buckling links-buckling"),
        moment_at_the_tip_forgotten: gates("bent-deflection bent-shortening bent-energy"),
        half_link_at_the_tip_rigid: gates("bent-energy"),
        modes_damped_a_tenth_less: gates(
            "beam-elements beam-segments beam-exact work-in damped kinetic elastic work-at-once damped-at-once "
            "released-elements released-segments released-exact released-kinetic released-elastic"
        ),
        loads_halved_in_time: gates(
            "beam-elements beam-segments beam-exact beam-exact-undamped work-in damped kinetic elastic "
            "work-at-once damped-at-once"
        ),
        works_without_their_second_half: gates("work-in damped work-at-once damped-at-once"),
        shapes_let_go_without_their_speed: gates("released-elements released-segments released-exact released-elastic"),
        shapes_let_go_a_thousandth_higher: gates(
            "released-elements released-segments released-exact released-kinetic released-elastic"
        ),
    },
    "guided-bar": {
        phases_of_the_wrong_sign: gates(
            "exact-deflection exact-slope exact-slow exact-imposed elements-deflection elements-slope "
            "links-deflection segments-deflection segments-beside-the-guide"
        ),
        second_and_further_forces_forgotten: gates(
            "exact-deflection exact-slope exact-slow elements-deflection elements-slope links-deflection "
            "segments-deflection segments-beside-the-guide"
        ),
        receptances_of_a_thousandth_more: gates("exact-receptance segments-receptance segments-receptance-at-the-wall"),
        displacements_held_at_one_place_alone: gates("exact-imposed"),
        losses_of_bending_twice_as_large: gates("elements-slope segments-beside-the-guide"),
        lever_and_reciprocal_pair_exchanged: gates(
            "links-deflection segments-deflection segments-beside-the-guide segments-receptance "
            "segments-receptance-at-the-wall"
        ),
        gregorys_weights_a_thousandth_off: gates(
            "gregory-law links-deflection segments-deflection segments-beside-the-guide segments-receptance "
            "segments-receptance-at-the-wall segments-shape links-buckling"
        ),
        cubics_of_elements_a_thousandth_too_long: gates("elements-deflection elements-slope elements-shape"),
        exact_shapes_from_the_other_end: gates(
            "fem-order half-wall-order gregory-law exact-shape exact-shape-slope elements-shape segments-shape"
        ),
        shapes_of_twice_the_modal_mass: gates(
            "segments-receptance segments-receptance-at-the-wall exact-shape exact-shape-slope elements-shape "
            "segments-shape"
        ),
        slopes_for_deflections_of_exact_shapes: gates("exact-shape exact-shape-slope"),
        columns_a_hundredth_too_strong: gates("exact-buckling elements-buckling links-buckling"),
        roots_of_a_beam_with_one_half_wave_too_many: gates("exact-mode-1 exact-mode-6"),
    },
    "free-free-bar": {
        phases_of_the_wrong_sign: gates(
            "exact-deflection exact-slow exact-slow-slope exact-curvature elements-deflection segments-deflection "
            "segments-slope-at-the-end segments-by-a-ratio"
        ),
        second_and_further_forces_forgotten: gates(
            "exact-deflection exact-slow exact-slow-slope exact-curvature elements-deflection segments-deflection "
            "segments-slope-at-the-end segments-by-a-ratio"
        ),
        losses_of_bending_twice_as_large: gates("segments-slope-at-the-end"),
        ratios_of_a_tenth_more: gates("segments-by-a-ratio"),
        lever_and_reciprocal_pair_exchanged: gates("segments-deflection segments-slope-at-the-end segments-by-a-ratio"),
        cubics_of_elements_a_thousandth_too_long: gates("elements-deflection elements-shape"),
        shapes_of_twice_the_modal_mass: gates("segments-by-a-ratio elements-shape segments-shape exact-shape"),
        slopes_for_deflections_of_exact_shapes: gates("exact-shape"),
    },
    "stepped-beam": {
        phases_of_the_wrong_sign: gates(
            "exact-deflection exact-slope exact-curvature exact-slow elements-deflection elements-slope "
            "elements-by-a-ratio links-deflection links-slope raw-joints "
            "surface-first-section surface-second-section"
        ),
        second_and_further_forces_forgotten: gates(
            "exact-deflection exact-slope exact-curvature exact-slow elements-deflection elements-slope "
            "elements-by-a-ratio links-deflection links-slope raw-joints "
            "surface-first-section surface-second-section"
        ),
        surfaces_of_the_beams_own_section_everywhere: gates("surface-second-section"),
        surfaces_of_the_next_section: gates("surface-first-section surface-second-section"),
        receptances_of_a_thousandth_more: gates("exact-receptance"),
        losses_of_bending_twice_as_large: gates("elements-deflection links-deflection raw-joints"),
        ratios_of_a_tenth_more: gates("elements-by-a-ratio"),
        lever_and_reciprocal_pair_exchanged: gates("links-deflection links-slope raw-joints"),
        links_turned_by_a_thousandth_more: gates("links-slope"),
        gregorys_weights_a_thousandth_off: gates("links-deflection links-slope raw-joints links-buckling"),
        cubics_of_elements_a_thousandth_too_long: gates(
            "elements-deflection elements-slope elements-by-a-ratio elements-shape"
        ),
        exact_shapes_from_the_other_end: gates("exact-shape exact-shape-slope"),
        shapes_of_twice_the_modal_mass: gates("elements-by-a-ratio exact-shape exact-shape-slope elements-shape"),
        slopes_for_deflections_of_exact_shapes: gates("exact-shape exact-shape-slope"),
        columns_a_hundredth_too_strong: gates("exact-buckling elements-buckling links-buckling"),
    },
    "taut-strip": {
        phases_of_the_wrong_sign: gates(
            "exact-deflection exact-slope elements-deflection elements-slope links-deflection links-slope "
            "segments-deflection taut-reflection"
        ),
        second_and_further_forces_forgotten: gates(
            "exact-deflection exact-slope elements-deflection elements-slope links-deflection links-slope "
            "segments-deflection taut-reflection"
        ),
        receptances_of_a_thousandth_more: gates("exact-receptance elements-receptance segments-receptance"),
        losses_of_bending_twice_as_large: gates(
            "elements-deflection elements-receptance links-deflection segments-receptance"
        ),
        lever_and_reciprocal_pair_exchanged: gates(
            "links-deflection links-slope segments-deflection segments-receptance"
        ),
        links_turned_by_a_thousandth_more: gates("links-slope"),
        cubics_of_elements_a_thousandth_too_long: gates("elements-deflection elements-receptance elements-slope"),
        exact_shapes_from_the_other_end: gates("exact-shape"),
        shapes_of_twice_the_modal_mass: gates("exact-shape"),
        slopes_for_deflections_of_exact_shapes: gates("exact-shape"),
        columns_a_hundredth_too_strong: gates("exact-buckling elements-buckling links-buckling tensioned-buckling"),
        joints_that_do_not_follow_the_load: gates("tensioned-buckling"),
        wavenumber_of_the_beam_alone: gates("taut-reflection"),
    },
    "instrument-arm": {
        turn_of_a_clamps_spring_taken_for_that_of_its_joint: gates("mended-rayleigh-order mended-timoshenko-order"),
        bodies_let_go_without_their_turn: gates("thrown-kinetic let-go-elements let-go-segments"),
        bodies_that_turn_with_the_line_through_the_joints: gates("thrown-kinetic let-go-segments"),
        rotary_inertia_of_no_share: gates("thrown-kinetic let-go-segments"),
        shapes_let_go_without_their_speed: gates("thrown-kinetic let-go-elements let-go-segments"),
        shapes_let_go_a_thousandth_higher: gates("thrown-kinetic let-go-elements let-go-segments"),
        modes_damped_a_tenth_less: gates("let-go-elements let-go-segments"),
        phases_of_the_wrong_sign: gates(
            "exact-deflection exact-slope exact-curvature exact-slow elements-deflection elements-slope "
            "levers-deflection levers-slope"
        ),
        second_and_further_forces_forgotten: gates(
            "exact-deflection exact-slope exact-curvature exact-slow elements-deflection elements-slope "
            "levers-deflection levers-slope"
        ),
        receptances_of_a_thousandth_more: gates("exact-receptance elements-receptance"),
        losses_of_bending_twice_as_large: gates("elements-deflection elements-receptance levers-deflection"),
        lever_and_reciprocal_pair_exchanged: gates("levers-deflection levers-slope"),
        links_turned_by_a_thousandth_more: gates("levers-slope"),
        cubics_of_elements_a_thousandth_too_long: gates(
            "elements-deflection elements-slope elements-receptance elements-shape"
        ),
        exact_shapes_from_the_other_end: gates("exact-shape exact-shape-slope"),
        shapes_of_twice_the_modal_mass: gates("exact-shape exact-shape-slope elements-shape"),
        slopes_for_deflections_of_exact_shapes: gates("exact-shape exact-shape-slope"),
        columns_a_hundredth_too_strong: gates("exact-buckling elements-buckling links-buckling"),
    },
    "thick-bar": {
        phases_of_the_wrong_sign: gates("exact-deflection exact-slope rayleigh-deflection thick-reflection"),
        second_and_further_forces_forgotten: gates(
            "exact-deflection exact-slope rayleigh-deflection thick-reflection rayleigh-reflection"
        ),
        receptances_of_a_thousandth_more: gates("exact-receptance"),
        exact_shapes_from_the_other_end: gates("exact-shape exact-shape-slope rayleigh-shape"),
        shapes_of_twice_the_modal_mass: gates("exact-shape exact-shape-slope rayleigh-shape"),
        slopes_for_deflections_of_exact_shapes: gates("exact-shape exact-shape-slope rayleigh-shape"),
        wavenumber_of_the_beam_alone: gates("thick-reflection rayleigh-reflection"),
    },
    "paper-wave": {
        receptances_of_a_thousandth_more: gates("fastest-crests receptance-beside-the-right-end"),
        limit_of_reflection_a_hundredth_looser: gates("fastest-crests fastest-crests-imposed"),
        sensitivities_of_forces_for_those_of_displacements: gates(
            "imposed-on-resonance fastest-crests-imposed imposed-reflection-per-hertz imposed-reflection-per-degree"
        ),
    },
}
"""By scene: each fault with gates that it turns red."""
