"""The paper's gates are green, and each turns red when the fault it exists for is planted."""

from dataclasses import replace
from math import inf, nan

import numpy as np
import pytest
from msgspec import structs

from verify.beam import Beam
from verify.chain import departure as axial_study
from verify.chain import dynamics as chain_dynamics
from verify.chain import problems as chain_studies
from verify.chain import records as chain_records
from verify.chain import ride as chain_ride
from verify.chain import splitting as chain_modal
from verify.chain import statics as chain_statics
from verify.chain import system as chain_system
from verify.elements import in_time as fem_motion
from verify.elements import linear as fem_beam
from verify.elements import mesh as element_mesh
from verify.elements import pencil as element_pencil
from verify.elements import stock
from verify.errors import InputError
from verify.exact import closed_forms, section_minors
from verify.exact import harmonic as analytic_harmonic
from verify.exact import modes as analytic_modes
from verify.judge import compare, sizing, workbench
from verify.judge.compare import Bracket
from verify.models import division, eigen
from verify.models import driven_pencil as harmonic_solvers
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
from verify.motion import figures as slider_figures
from verify.motion import kernels as contact_kernels
from verify.options import WALLS
from verify.quantities import cases
from verify.quantities import simulated as motions
from verify.quantities.catalogue import QUANTITIES, Quantity
from verify.run.gates import expectation, judge
from verify.run.plan import asks_of
from verify.run.runner import workbench_for
from verify.scenes.checked import checked
from verify.scenes.scene import Complex, Gate, load_scene, packaged_scenes
from verify.segments import in_time as segment_motion
from verify.segments import linear as segment_model
from verify.segments import links as chain
from verify.segments import reading as segment_reading
from verify.segments import walls as chain_walls
from verify.waves import driven as waves
from verify.waves import measures as travelling_wave
from verify.waves import operating_point

PAPER = load_scene("paper")


def failed_gates(scene=PAPER, among=None):
    bench = workbench_for(scene, gates_only=True)
    asked = [gate for gate in scene.gate if among is None or gate.id in among]
    return {gate.id for gate in asked if not judge(gate, scene, bench).passed}


def link_inertia_left_out(patch):
    patch.setattr(chain, "link_inertia", lambda mass, length: 0.0 * mass)


def joint_stiffness_doubled(patch):
    true = chain.joint_compliance
    patch.setattr(chain, "joint_compliance", lambda *links: true(*links) / 2)


def lumped_element_mass(patch):
    from scipy.sparse import diags_array

    def lumped(basis, mass):
        lengths = np.diff(basis.mesh.p[0])
        nodal = np.zeros(2 * len(lengths) + 2)
        nodal[:-2:2] += mass * lengths / 2
        nodal[2::2] += mass * lengths / 2
        nodal[1:-1:2] += mass * lengths**3 / 24
        nodal[3::2] += mass * lengths**3 / 24
        return diags_array(nodal).tocsc()

    for module in (element_pencil, fem_motion):
        patch.setattr(module, "mass_matrix", lumped)


def slope_polynomials_without_their_element_length(patch):
    true = element_pencil.element_curvatures
    patch.setattr(element_pencil, "element_curvatures", lambda lengths, nodal: true(1.001 * lengths, nodal))


def curvatures_of_another_weight(patch):
    """The gradient's share of K a millionth short, as if scikit-fem's K had been misread."""
    true = element_pencil.curvature_weights
    patch.setattr(
        element_pencil,
        "curvature_weights",
        lambda lengths, stiffness: true(lengths, stiffness) * np.repeat([1.0, 1.0 - 1e-6], len(lengths)),
    )


def lengths_of_the_mesh_in_the_wrong_order(patch):
    true = element_mesh.Elements.lengths.fget
    patch.setattr(element_mesh.Elements, "lengths", property(lambda elements: true(elements)[::-1]))


def stock_elements_one_too_few(patch):
    true = stock._solved
    patch.setattr(stock, "_solved", lambda beam, mode, n: true(beam, mode, n - 1))


def stock_beam_of_a_billionth_more_stiffness(patch):
    true = stock._solved
    patch.setattr(
        stock, "_solved", lambda beam, mode, n: true(replace(beam, youngs_modulus=70e9 * (1 + 1e-9)), mode, n)
    )


def modes_21_and_22_exchanged(patch):
    true = eigen.lowest

    def exchanged(pencil, n_modes):
        pairs = true(pencil, n_modes)
        order = np.arange(pairs.vectors.shape[1])
        if len(order) > 21:
            order[[20, 21]] = 21, 20
        return eigen.Eigenpairs(values=pairs.values, vectors=pairs.vectors[:, order], method=pairs.method)

    patch.setattr(segment_model, "lowest", exchanged)
    patch.setattr(fem_beam, "lowest", exchanged)


def joints_read_raw(patch):
    patch.setattr(segment_model, "corrected_reading", lambda links, joints: joints)


def shapes_with_unit_amplitude_instead_of_unit_mass(patch):
    true = eigen.factored_quotient

    def rescaled(pencil, vectors):
        values, scaled = true(pencil, vectors)
        return values, scaled / abs(scaled).max(axis=0)

    patch.setattr(eigen, "factored_quotient", rescaled)


def section_turned_on_its_side(patch):
    patch.setattr(Beam, "wave_constant", property(lambda b: (b.youngs_modulus / b.density / 12) ** 0.5 * b.width))


def roots_of_a_beam_with_one_half_wave_too_many(patch):
    true = closed_forms.root_parts
    patch.setattr(closed_forms, "root_parts", lambda supports, mode: true(supports, mode + 1))


def rotary_inertia_without_the_twelfth(patch):
    true = closed_forms._thickness_factor
    patch.setattr(closed_forms, "_thickness_factor", lambda beam, beta, theory: true(beam, 12**0.5 * beta, theory))


def shear_coefficient_of_one(patch):
    from msgspec.structs import replace

    true = closed_forms._thickness_factor
    patch.setattr(
        closed_forms, "_thickness_factor", lambda b, beta, theory: true(replace(b, shear_coefficient=1.0), beta, theory)
    )


def wavelength_for_its_quarter(patch):
    true = closed_forms.quarter_wavelength
    patch.setattr(closed_forms, "quarter_wavelength", lambda *given: 4 * true(*given))


def mean_instead_of_root_mean_square_of_mode_numbers_one_too_high(patch):
    true = closed_forms.rule_frequency_hz
    patch.setattr(closed_forms, "rule_frequency_hz", lambda beam, low, high: true(beam, low + 1, high + 1))


def bracket_of_one_model_alone(patch):
    true = workbench.Workbench.frequency_hz
    patch.setattr(
        workbench.Workbench,
        "frequency_hz",
        lambda self, model, count, mode, settings=(): (
            true(self, "fem", count, mode) * (1 - 1e-4 * (model == "segment"))
        ),
    )


def order_from_the_wrong_logarithm(patch):
    true = compare.observed_order
    patch.setattr(compare, "observed_order", lambda counts, errors: true([n**2 for n in counts], errors))


def error_relative_to_the_computed_frequency_with_its_sign_lost(patch):
    patch.setattr(compare, "relative_error", lambda value, exact: abs(value - exact) / value)


def count_one_too_high(patch):
    from msgspec.structs import replace

    from verify.quantities import catalogue as quantities

    found = QUANTITIES["mode.count_needed"]
    wrong: Quantity = replace(found, evaluate=lambda *given: found.evaluate(*given) + 1)
    patch.setitem(quantities.QUANTITIES, "mode.count_needed", wrong)


def sizes_sought_from_below(patch):
    """The first size that does for the one from which on all do."""
    true = sizing._scanned

    def first(*given):
        count, smaller, tried = true(*given)
        return smaller or count, None, tried

    patch.setattr(sizing, "_scanned", first)


def dips_overlooked(patch):
    true = sizing._scanned
    patch.setattr(sizing, "_scanned", lambda *given: (true(*given)[0], None, true(*given)[2]))


def wall_joint_as_stiff_as_any_other(patch):
    patch.setattr(chain_walls, "_CORRECTIONS", dict.fromkeys(WALLS, ()))


def gregorys_weights_turned_round(patch):
    patch.setitem(chain_walls._CORRECTIONS, "gregory", (-5 / 8, -1 / 24, 1 / 6))


def orders_of_the_other_walls_exchanged(patch):
    walls = chain_walls._CORRECTIONS
    patch.setattr(
        chain_walls, "_CORRECTIONS", {**walls, "third-order": walls["half"], "five-joint": walls["third-order"]}
    )


def welded_half_forgotten(patch):
    patch.setattr(chain, "welded_halves", lambda supports: (0, 0))


def welded_halves_at_each_others_ends(patch):
    true = chain.welded_halves
    patch.setattr(chain, "welded_halves", lambda supports: true(supports)[::-1])


def mirrored(beam):
    return structs.replace(beam, supports=beam.supports[::-1])


def clamped_end_on_the_wrong_side(patch):
    true_chain, true_free = segment_model.build_chain, element_mesh.free_unknowns
    patch.setattr(segment_model, "build_chain", lambda beam, *given, **more: true_chain(mirrored(beam), *given, **more))
    patch.setattr(element_mesh, "free_unknowns", lambda basis, supports: true_free(basis, supports[::-1]))


def section_order_reversed(patch):
    true = chain.divide

    def reversed_sections(beam, *given):
        return true(structs.replace(beam, section=beam.section[::-1]), *given)

    patch.setattr(chain, "divide", reversed_sections)
    patch.setattr(element_mesh, "divide", reversed_sections)


def sections_carried_in_the_wrong_order(patch):
    true = analytic_modes._stretches
    patch.setattr(analytic_modes, "_stretches", lambda beam: true(beam)[::-1])


def minors_without_their_rest(patch):
    """What a minor keeps of itself, (1 + cos cosh) / 2, a millionth short."""
    true = section_minors._waves
    patch.setattr(section_minors, "_waves", lambda y: (*true(y)[:-1], (1.0 - 1e-6) * true(y)[-1]))


def printed_equation_for_the_series_form(patch):
    true = segment_model.build_chain
    patch.setattr(segment_model, "build_chain", lambda *given, **more: true(*given, **{**more, "joints": "printed"}))


def series_form_for_the_printed_equation(patch):
    true = segment_model.build_chain
    patch.setattr(segment_model, "build_chain", lambda *given, **more: true(*given, **{**more, "joints": "series"}))


def elements_that_ignore_the_step(patch):
    true = element_mesh.divide

    def uniform(beam, *given):
        parts = true(beam, *given)
        return structs.replace(parts, moduli=np.ones_like(parts.moduli))

    patch.setattr(element_mesh, "divide", uniform)


def grading_that_stretches_the_last_part_alone(patch):
    true = division._graded

    def stretched(length, n, grading):
        lengths = true(length, n, 1.0)
        lengths[-1] *= 1.0 + 0.5 * (grading != 1.0)
        return lengths

    patch.setattr(division, "_graded", stretched)


def parts_taken_from_the_first_section_that_has_them(patch):
    """By no remainder: the middle section gives one to the first."""
    true = division.part_counts

    def shifted(lengths, count):
        counts = true(lengths, count)
        middle = counts.index(max(counts))
        counts[middle] -= 1
        counts[0] += 1
        return counts

    patch.setattr(division, "part_counts", shifted)


def grading_over_one_part_too_many(patch):
    true = division._graded
    patch.setattr(division, "_graded", lambda length, n, g: true(length, n, g ** ((n - 1) / n) if n > 1 else g))


def sections_of_the_mean_thickness(patch):
    """Each part keeps its material and gets the thickness of the whole."""
    for module in (chain, element_mesh):
        true = module.divide

        def even(beam, *given, true=true):
            return true(
                structs.replace(
                    beam, section=tuple(structs.replace(part, thickness=beam.thickness) for part in beam.section)
                ),
                *given,
            )

        patch.setattr(module, "divide", even)


def link_curvature_for_the_joints_moment(patch):
    true = segment_model.joint_curvatures
    patch.setattr(segment_model, "joint_curvatures", lambda links, joints: true(links, joints) * links.compliances)


def one_rigid_motion_too_few(patch):
    patch.setattr(Beam, "rigid_motions", property(lambda beam: 1))


def nodes_counted_from_the_other_end_of_the_shape(patch):
    true = compare.zeros
    patch.setattr(compare, "zeros", lambda shape, length, mode: true(lambda x: shape(0.99 * x), length, mode))


def phase_of_the_wrong_sign(patch):
    for module in (analytic_harmonic, fem_beam, segment_model):
        true = module.phasor
        patch.setattr(module, "phasor", lambda force, true=true: true(force).conjugate())


def second_force_a_tenth_nearer(patch):
    true = cases.drive_forces

    def moved(a, scene):
        first, second = true(a, scene)
        return first, structs.replace(second, position=0.9 * second.position)

    patch.setattr(cases, "drive_forces", moved)


def load_on_the_next_joint(patch):
    true = segment_model.joint_weights
    patch.setattr(segment_model, "joint_weights", lambda chain, position, rule: np.roll(true(chain, position, rule), 1))


def load_on_the_next_node(patch):
    true = fem_beam.point_loads
    patch.setattr(fem_beam, "point_loads", lambda basis, x: np.roll(true(basis, x), 2, axis=1))


def mid_line_instead_of_surface(patch):
    patch.setattr(travelling_wave, "surface_motion", lambda beam, slope: 0.0 * slope)


def lower_surface_for_the_upper(patch):
    true = travelling_wave.surface_motion
    patch.setattr(travelling_wave, "surface_motion", lambda beam, slope: -true(beam, slope))


def waves_fitted_with_the_wrong_sign_of_time(patch):
    true = travelling_wave.wave_basis
    patch.setattr(travelling_wave, "wave_basis", lambda x, k, middle: true(x, np.conj(-np.asarray(k)), middle))


def wavenumber_two_per_cent_off(patch):
    true = waves.own_wavenumber
    patch.setattr(waves, "own_wavenumber", lambda field: 1.02 * true(field))


def stiffness_without_its_loss(patch):
    true = analytic_harmonic.wavenumber
    patch.setattr(analytic_harmonic, "wavenumber", lambda beam, f: true(structs.replace(beam, loss_factor=0.0), f))


def ratio_twice_as_large(patch):
    for module in (fem_beam, segment_model):
        true = module.damped_response

        def doubled(pencil, loads, omega2, stiffness, ratio, true=true):
            return true(pencil, loads, omega2, stiffness, 2 * ratio)

        patch.setattr(module, "damped_response", doubled)


def modes_of_the_driven_pencil_without_their_losses(patch):
    """The modal sum leaves out what the stiffness loses."""
    for module in (fem_beam, segment_model):
        true = module.damped_response

        def lossless(pencil, loads, omega2, stiffness, ratio, true=true):
            return true(pencil, loads, omega2, stiffness.real + 0j if ratio else stiffness, ratio)

        patch.setattr(module, "damped_response", lossless)


def losses_that_feed(patch):
    """The field of a growing time, for the direct solve and the sum over modes."""
    for module in (fem_beam, segment_model):
        direct, summed = module.damped_response, module.modal_receptance

        def response(pencil, loads, omega2, stiffness, ratio, true=direct):
            return true(pencil, loads, omega2, stiffness.conj(), -ratio)

        def receptance(pencil, weights, omega2, eta, true=summed):
            return true(pencil, weights, omega2, -eta)

        patch.setattr(module, "damped_response", response)
        patch.setattr(module, "modal_receptance", receptance)


def modes_summed_with_their_sign_lost(patch):
    for module in (fem_beam, segment_model):
        true = module.modal_receptance

        def turned(*given, true=true):
            modes, shares = true(*given)
            return modes, -shares

        patch.setattr(module, "modal_receptance", turned)


def modes_summed_at_frequencies_a_thousandth_higher(patch):
    true = harmonic_solvers.modal_basis

    def higher(pencil):
        values, vectors = true(pencil)
        return 1.001 * values, vectors

    patch.setattr(harmonic_solvers, "modal_basis", higher)


def sensitivities_exchanged(patch):
    true = operating_point.driven_point

    def exchanged(*given):
        found = true(*given)
        return structs.replace(found, per_hertz=found.per_degree, per_degree=found.per_hertz)

    patch.setattr(operating_point, "driven_point", exchanged)


def changes_of_both_sides_with_their_signs(patch):
    """On a slope they cancel: what is left is the curvature."""
    true = operating_point.Landscape.at

    def mirrored_at(self, frequency, phase):
        here = true(self, 4276.0, 90.0)
        there = true(self, frequency, phase)
        other = true(self, 2 * 4276.0 - frequency, 180.0 - phase)
        return here[0] + 0.5 * (there[0] + other[0] - 2 * here[0]), there[1]

    patch.setattr(operating_point.Landscape, "at", mirrored_at)


def displacement_taken_for_force(patch):
    patch.setattr(waves, "driven_field", lambda solve, drives, frequency, kind: solve(drives, frequency))


def near_field_forgotten(patch):
    true = analytic_harmonic._green

    def far(q, *given):
        return true(q, *given) * (abs(q.imag) > abs(q.real))

    patch.setattr(analytic_harmonic, "_green", far)


def lever_rule_and_raw_joints_by_mistake(patch):
    true_load = segment_model.joint_weights
    patch.setattr(segment_model, "joint_weights", lambda chain, position, rule: true_load(chain, position, "lever"))
    patch.setattr(segment_model, "corrected_reading", lambda chain, joints: joints)


def reciprocal_pair_where_the_lever_was_asked_for(patch):
    true = segment_model.joint_weights
    patch.setattr(segment_model, "joint_weights", lambda chain, position, rule: true(chain, position, "reciprocal"))
    patch.setattr(
        segment_model,
        "_field_shapes",
        lambda chain, raw, reading, true=segment_model._field_shapes: true(chain, raw, "corrected"),
    )


def power_of_both_waves_added(patch):
    true = travelling_wave.energy_flux
    patch.setattr(
        travelling_wave,
        "energy_flux",
        lambda beam, omega, k, a, b: true(beam, omega, k, a, 0 * b) - true(beam, omega, k, 0 * a, b),
    )


def singular_values_squared(patch):
    true = travelling_wave.travelling_index
    patch.setattr(travelling_wave, "travelling_index", lambda *given: true(*given) ** 2)


def links_that_feel_no_inertia_of_the_links_beyond(patch):
    true = chain_dynamics.mass_matrix
    patch.setattr(chain_dynamics, "mass_matrix", lambda system, theta: np.diag(np.diag(true(system, theta))))


def hanging_links_with_inertia_about_their_ends(patch):
    patch.setattr(chain_studies, "link_inertia", lambda mass, length: mass * length**2 / 3)


def clamp_that_turns_without_a_centrifugal_pull(patch):
    patch.setattr(
        chain_statics, "centrifugal", lambda system, theta: (0.0 * theta, 0.0 * chain_statics.mass_products(system))
    )


def links_pulled_straight_as_if_they_flapped(patch):
    true = chain_statics.centrifugal

    def flapping(system, theta):
        gradient, stiffness = true(system, theta)
        return gradient, np.diag(np.diag(stiffness))

    patch.setattr(chain_statics, "centrifugal", flapping)


def departures_at_mid_span_wherever_they_are_asked_for(patch):
    true = axial_study.driven_chain
    patch.setattr(
        axial_study, "driven_chain", lambda scene, who, count, duration, x: true(scene, who, count, duration, None)
    )


def axial_spring_of_half_the_section(patch):
    true = chain_studies.build_system

    def softened(*given, **more):
        system = true(*given, **more)
        return replace(system, axial_spring=0.5 * system.axial_spring)

    patch.setattr(chain_studies, "build_system", softened)


def recursion_with_another_inertia_than_the_energy(patch):
    true = chain_records.mobilities
    patch.setattr(chain_records, "mobilities", lambda half, masses, inertias: true(half, masses, 1.01 * inertias))


def forces_that_lag_instead_of_lead(patch):
    true = chain_system.transverse_loads

    def lagging(*given):
        return tuple(replace(load, phase_deg=-load.phase_deg) for load in true(*given))

    patch.setattr(chain_system, "transverse_loads", lagging)


def kicks_of_no_strength(patch):
    patch.setitem(chain_modal.SCHEMES, 2, (chain_modal.SCHEMES[2][0], (0.0, 0.0)))


def axial_inertia_forgotten(patch):
    true = chain_studies.build_system
    patch.setattr(
        chain_studies, "build_system", lambda *given, **more: replace(true(*given, **more), axial_inertia=False)
    )


def axial_inertia_kept_where_it_was_to_go(patch):
    true = chain_studies.build_system
    patch.setattr(
        chain_studies, "build_system", lambda *given, **more: replace(true(*given, **more), axial_inertia=True)
    )


def linear_chain_under_a_tenth_of_a_per_cent_more(patch):
    true = axial_study.linear_deflection
    patch.setattr(axial_study, "linear_deflection", lambda *given: 1.001 * true(*given))


def departures_of_the_whole_run_for_those_at_its_end(patch):
    true = axial_study.departure_of

    def exchanged(*given):
        found = true(*given)
        return structs.replace(found, at_end=found.rms, rms=found.at_end)

    patch.setattr(axial_study, "departure_of", exchanged)


def links_that_stretch_a_tenth_less(patch):
    true = axial_study.simulate_elastic
    patch.setattr(
        axial_study,
        "simulate_elastic",
        lambda system, stiffness, times, **more: true(system, 1.1 * stiffness, times, **more),
    )


def links_that_do_not_shorten_where_they_turn(patch):
    true = axial_study.simulate_elastic
    patch.setattr(axial_study, "simulate_elastic", lambda *given, **more: true(*given, immovable=True, **more))


def slider_on_a_chain_that_does_not_draw_in(patch):
    true = chain_ride._surface

    def still_along(*given):
        local, along, edges = true(*given)
        return local, 0.0 * along, edges

    patch.setattr(chain_ride, "_surface", still_along)


def slider_on_links_that_stretch_a_tenth_less(patch):
    true = chain_ride.simulate_elastic
    patch.setattr(
        chain_ride,
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


def contact_line_that_does_not_know_the_wall(patch):
    from scipy.interpolate import CubicSpline

    patch.setattr(
        segment_reading, "spline", lambda chain, values: CubicSpline(chain.nodes, values, axis=1, bc_type="natural")
    )


def joints_corrected_as_if_their_links_were_equal(patch):
    true = segment_reading.corrected_reading

    def equal(chain, joints):
        found = true(chain, joints)
        found[:, 1:-1] = joints[:, 1:-1] + np.diff(joints, 2, axis=1) / 12.0
        return found

    patch.setattr(segment_reading, "corrected_reading", equal)


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


def held_slider_without_inertia(patch):
    """Nor weight: only friction is given back to the beam."""
    true = carried.law_of
    patch.setattr(carried, "law_of", lambda *given: true(*given)._replace(held=False))


def weight_of_another_load(patch):
    true = carried.law_of
    patch.setattr(carried, "law_of", lambda *given: law_with(true(*given), load=1.001))


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


def driving_point_read_a_node_off(patch):
    """The response to a unit force is that of one a twentieth of a millimetre away."""
    true = motions.PointForce
    patch.setattr(motions, "PointForce", lambda position: true(position=position + 5e-5))


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
    true = fem_motion.point_loads
    patch.setattr(fem_motion, "point_loads", lambda basis, x: np.roll(true(basis, x), 2, axis=1))


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


def means_of_the_size_alone(patch):
    true = slider_figures.mean
    patch.setattr(slider_figures, "mean", lambda times, values: true(times, abs(values)))


def phases_left_as_they_are_where_they_were_to_turn(patch):
    patch.setattr(motions, "turned", tuple)


def ends_for_the_largest(patch):
    """The run is looked at where it ends, not at every step."""
    true = motions.with_slider
    patch.setattr(motions, "with_slider", lambda *given, sampled, **more: true(*given, sampled=False, **more))


FAULTS_ELSEWHERE = {
    "paper-slider": {
        slider_on_a_chain_that_does_not_draw_in: {"chain-slider", "chain-slider-on-links-that-stretch"},
        slider_on_links_that_stretch_a_tenth_less: {"chain-slider-on-links-that-stretch"},
        slider_on_a_chain_that_feels_the_mid_line: {"chain-slider", "chain-slider-in-the-limit"},
        slider_on_a_chain_under_another_gravity: {"chain-slider-in-the-limit", "chain-slider-saturates"},
        friction_booked_at_a_thousandth_less: {"chain-slider-books"},
        means_of_the_size_alone: {"slider-mean-friction", "slider-mean-surface-speed"},
        phases_left_as_they_are_where_they_were_to_turn: {"slider-turned-round"},
        ends_for_the_largest: {"slider-largest-friction", "slider-mean-friction", "slider-mean-surface-speed"},
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
        held_slider_without_inertia: {"held-steady-segments", "held-steady-elements", "held-from-rest"},
        steady_start_without_the_mass: {"held-steady-segments", "held-steady-elements"},
        start_without_the_sag: {"held-steady-segments", "held-steady-elements"},
        mass_that_pulls_the_beam_along: {"loaded-exact", "loaded-segments", "loaded-elements"},
        friction_at_the_mid_line: {"friction-size"},
        driving_point_read_a_node_off: {"normal-size", "loaded-exact"},
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
        lumped_element_mass: {"slider-elements", "slider-order-fem", "beam-elements"},
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
        surface_seen_half_a_step_late: {"slider-order-step", "slider-step-steep"},
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
    "chain": {
        wall_joint_as_stiff_as_any_other: {"elastica-deflection", "elastica-shortening", "rollup-gap-of-gregory"},
        joint_stiffness_doubled: {
            "elastica-deflection",
            "elastica-shortening",
            "rollup-closes",
            "rollup-gap-of-gregory",
            "small-force",
        },
        links_that_feel_no_inertia_of_the_links_beyond: {"hanging-two-links", "hanging-limit"},
        hanging_links_with_inertia_about_their_ends: {"hanging-one-link", "hanging-two-links"},
        axial_spring_of_half_the_section: {"large-amplitude"},
        clamp_that_turns_without_a_centrifugal_pull: {"turning-slow", "turning-fast", "turning-third-mode"},
        links_pulled_straight_as_if_they_flapped: {"turning-slow", "turning-fast", "turning-third-mode"},
        departures_at_mid_span_wherever_they_are_asked_for: {"departure-at-two-fifths", "departure-at-seven-tenths"},
        recursion_with_another_inertia_than_the_energy: {"energy-is-kept", "small-force", "ten-newton"},
        forces_that_lag_instead_of_lead: {
            "small-force",
            "ten-newton",
            "ten-newton-by-kicks",
            "ten-newton-without-axial-inertia",
        },
        kicks_of_no_strength: {"ten-newton-by-kicks"},
        axial_inertia_forgotten: {
            "ten-newton",
            "ten-newton-by-kicks",
            "departure-at-a-tenth-of-a-newton",
            "departure-at-one-newton",
            "departure-at-ten-newton",
            "departure-at-ten-newton-in-the-rms",
        },
        axial_inertia_kept_where_it_was_to_go: {"ten-newton-without-axial-inertia", "departure-without-axial-inertia"},
        linear_chain_under_a_tenth_of_a_per_cent_more: {
            "departure-at-a-tenth-of-a-newton",
            "departure-at-one-newton",
            "departure-at-ten-newton",
            "departure-without-axial-inertia",
            "departure-of-links-that-stretch",
        },
        departures_of_the_whole_run_for_those_at_its_end: {
            "departure-at-one-newton",
            "departure-at-ten-newton",
            "departure-at-ten-newton-in-the-rms",
            "departure-without-axial-inertia",
            "departure-of-links-that-stretch",
        },
        links_that_stretch_a_tenth_less: {"departure-of-links-that-stretch"},
        links_that_do_not_shorten_where_they_turn: {"departure-of-links-that-stretch"},
    },
    "paper-wave": {
        phase_of_the_wrong_sign: {"reversal-turns-the-wave", "surface-ellipse", "flux", "mid-span"},
        second_force_a_tenth_nearer: {
            "distance-sets-the-amplitude",
            "pure-wave",
            "reversal-turns-the-wave",
            "mid-span",
        },
        load_on_the_next_joint: {
            "segment-49-ratio",
            "segment-ratio-order",
            "segment-deflection-order",
            "lever-rule-order",
        },
        load_on_the_next_node: {"mid-span"},
        mid_line_instead_of_surface: {"surface-ellipse", "segment-ellipse-order", "fem-ellipse-order"},
        lower_surface_for_the_upper: {"surface-ellipse"},
        waves_fitted_with_the_wrong_sign_of_time: {"reversal-turns-the-wave", "distance-sets-the-amplitude", "flux"},
        wavenumber_two_per_cent_off: {
            "swr-law",
            "distance-sets-no-ratio",
            "pure-wave",
            "best-frequency",
            "segment-best-frequency",
            "fem-best-frequency",
        },
        stiffness_without_its_loss: {"energy-flux", "reversal-keeps-the-ratio"},
        displacement_taken_for_force: {"imposed-displacement"},
        near_field_forgotten: {"signed-area", "signed-area-beside-the-forces"},
        lever_rule_and_raw_joints_by_mistake: {"segment-deflection-order"},
        reciprocal_pair_where_the_lever_was_asked_for: {"lever-rule-order"},
        lumped_element_mass: {"fem-49-ratio", "fem-ratio-order", "fem-ellipse-order", "fem-best-frequency", "mid-span"},
        link_inertia_left_out: {"segment-49-ratio", "segment-best-frequency", "segment-ratio-order"},
        power_of_both_waves_added: {"flux", "energy-flux"},
        singular_values_squared: {"travelling-index"},
        section_turned_on_its_side: {"swr-law", "envelope", "best-frequency"},
        ratio_twice_as_large: {"ratio-on-elements", "three-dampings-on-segments"},
        modes_of_the_driven_pencil_without_their_losses: {"ratio-on-elements", "three-dampings-on-segments"},
        losses_that_feed: {
            "loss-on-elements",
            "ratio-on-elements",
            "dashpots-on-segments",
            "three-dampings-on-segments",
            "receptance-of-elements",
        },
        modes_summed_with_their_sign_lost: {"receptance-of-elements", "receptance-of-segments"},
        modes_summed_at_frequencies_a_thousandth_higher: {
            "ratio-on-elements",
            "three-dampings-on-segments",
            "receptance-of-elements",
            "receptance-of-segments",
            "reflection-per-hertz",
        },
        sensitivities_exchanged: {"reflection-per-hertz", "reflection-per-degree"},
        changes_of_both_sides_with_their_signs: {"reflection-per-hertz", "reflection-per-degree"},
    },
    "patched-strip": {
        parts_taken_from_the_first_section_that_has_them: {
            "elements-at-24",
            "segments-at-24",
            "graded-elements-at-24",
            "graded-segments-at-24",
            "elements-at-96",
            "graded-segments-at-96",
        },
        grading_over_one_part_too_many: {"graded-elements-at-24", "graded-segments-at-24", "graded-segments-at-96"},
        grading_that_stretches_the_last_part_alone: {"graded-elements-at-24", "graded-segments-at-24"},
        sections_of_the_mean_thickness: {"elements-at-24", "segments-at-24", "fem-order", "fem-error"},
        lumped_element_mass: {"elements-at-24", "fem-order", "fem-error"},
        section_order_reversed: {"elements-at-96", "segments-at-24", "fem-error", "fem-order"},
    },
    "steel-cantilever": {
        contact_line_that_does_not_know_the_wall: {"contact-line-at-the-wall"},
        joints_corrected_as_if_their_links_were_equal: {"contact-line-on-unequal-links"},
        link_inertia_left_out: {"gregory-mode-10", "gregory-law", "gregory-law-after-the-sign-change"},
        count_one_too_high: {"segments-for-a-tenth-of-a-per-cent"},
        wall_joint_as_stiff_as_any_other: {
            "gregory-mode-1",
            "gregory-mode-5",
            "gregory-law",
            "half-wall-order",
            "third-order-wall-order",
            "five-joint-error",
            "curvature-order-of-size",
        },
        gregorys_weights_turned_round: {"gregory-mode-1", "gregory-mode-5", "gregory-law"},
        sizes_sought_from_below: {"segments-for-nine-ten-millionths"},
        dips_overlooked: {"segments-that-happen-to-do"},
        orders_of_the_other_walls_exchanged: {"third-order-wall-order", "five-joint-error"},
        welded_half_forgotten: {"welded-wall-order"},
        welded_halves_at_each_others_ends: {"welded-wall-shape"},
        clamped_end_on_the_wrong_side: {"gregory-mode-1", "shape-beside-the-wall"},
        joint_stiffness_doubled: {"gregory-mode-1", "half-wall-bracket"},
        lumped_element_mass: {"fem-order", "fem-law"},
        link_curvature_for_the_joints_moment: {"curvature-order-of-size"},
        roots_of_a_beam_with_one_half_wave_too_many: {"exact-mode-1", "gregory-mode-1"},
    },
    "free-free-bar": {
        link_inertia_left_out: {"segment-order", "segment-law", "mean-order", "bracket-mode-7", "shape-order"},
        lumped_element_mass: {"fem-order", "mean-order"},
        one_rigid_motion_too_few: {
            "segment-order",
            "fem-order",
            "bracket-mode-7",
            "node-by-segments",
            "node-by-elements",
        },
        joints_read_raw: {"shape-order"},
        shapes_with_unit_amplitude_instead_of_unit_mass: {"raw-shape-order", "shape-order"},
        nodes_counted_from_the_other_end_of_the_shape: {
            "node-of-the-first-mode",
            "node-by-segments",
            "node-by-elements",
        },
        section_turned_on_its_side: {"exact-mode-1", "bracket-mode-7"},
    },
    "stepped-beam": {
        sections_carried_in_the_wrong_order: {"exact-mode-1", "exact-mode-6", "fem-error", "series-error"},
        minors_without_their_rest: {"exact-mode-1", "exact-mode-6"},
        section_order_reversed: {
            "series-order",
            "fem-order",
            "fem-error",
            "series-error",
            "graded-elements",
            "graded-segments",
        },
        printed_equation_for_the_series_form: {"series-order", "series-error", "graded-segments"},
        series_form_for_the_printed_equation: {"printed-order"},
        elements_that_ignore_the_step: {"fem-order", "fem-error", "graded-elements"},
        curvatures_of_another_weight: {"factored-stiffness"},
        lengths_of_the_mesh_in_the_wrong_order: {"factored-stiffness"},
        lumped_element_mass: {"fem-order", "fem-error", "graded-elements"},
        clamped_end_on_the_wrong_side: {"series-order", "series-error", "fem-error", "printed-order"},
    },
}


FAULTS = {
    link_inertia_left_out: {
        "segment-dispersion",
        "segment-mode-22",
        "first-under-one-percent",
        "segment-order",
        "bracket-mode-22",
        "bracket-mode-5",
        "mean-mode-22",
        "mean-order",
        "segment-raw-shape-22",
        "segment-shape-22",
    },
    joint_stiffness_doubled: {"segment-dispersion", "segment-mode-22", "first-under-one-percent", "bracket-mode-22"},
    lumped_element_mass: {
        "fem-dispersion",
        "fem-mode-22",
        "fem-order",
        "bracket-mode-22",
        "mean-order",
        "fem-shape-22",
    },
    slope_polynomials_without_their_element_length: {"fem-dispersion", "fem-mode-22", "fem-order", "mean-mode-22"},
    curvatures_of_another_weight: {
        "factored-stiffness",
        "factored-stiffness-graded",
        "fem-dispersion",
        "stock-mode-22",
    },
    lengths_of_the_mesh_in_the_wrong_order: {"factored-stiffness-graded"},
    stock_elements_one_too_few: {"stock-mode-22", "stock-mode-1"},
    stock_beam_of_a_billionth_more_stiffness: {"stock-mode-22"},
    modes_21_and_22_exchanged: {"segment-mode-22", "fem-mode-22"},
    joints_read_raw: {"segment-shape-22"},
    shapes_with_unit_amplitude_instead_of_unit_mass: {"segment-shape-22", "segment-raw-shape-22", "fem-shape-22"},
    section_turned_on_its_side: {"exact-mode-22", "rayleigh-mode-22", "paper-mode-22", "drive-rule", "drive-distance"},
    roots_of_a_beam_with_one_half_wave_too_many: {
        "exact-mode-22",
        "rayleigh-mode-22",
        "timoshenko-mode-22",
        "paper-mode-22",
        "drive-rule",
        "segment-mode-22",
    },
    rotary_inertia_without_the_twelfth: {"rayleigh-mode-22", "timoshenko-mode-22"},
    shear_coefficient_of_one: {"timoshenko-mode-22"},
    wavelength_for_its_quarter: {"drive-distance"},
    mean_instead_of_root_mean_square_of_mode_numbers_one_too_high: {"drive-rule"},
    bracket_of_one_model_alone: {"bracket-mode-22", "bracket-mode-5", "mean-mode-22"},
    order_from_the_wrong_logarithm: {"segment-order", "fem-order", "mean-order"},
    error_relative_to_the_computed_frequency_with_its_sign_lost: {"segment-mode-22", "fem-mode-22", "mean-mode-22"},
    count_one_too_high: {"first-under-one-percent"},
}


def test_the_papers_gates_are_green():
    assert failed_gates() == set()


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.__name__)
def test_a_planted_fault_turns_its_gates_red(fault, monkeypatch):
    fault(monkeypatch)
    assert failed_gates() >= FAULTS[fault]


def test_no_gate_of_the_paper_is_without_a_fault_that_turns_it_red():
    assert {gate.id for gate in PAPER.gate} == set().union(*FAULTS.values())


ELSEWHERE = [(scene, fault) for scene, faults in FAULTS_ELSEWHERE.items() for fault in faults]


@pytest.mark.parametrize(("scene", "fault"), ELSEWHERE, ids=lambda part: getattr(part, "__name__", part))
def test_a_planted_fault_turns_gates_of_other_scenes_red(scene, fault, monkeypatch):
    fault(monkeypatch)
    expected = FAULTS_ELSEWHERE[scene][fault]
    assert failed_gates(load_scene(scene), among=expected) == expected


@pytest.mark.parametrize("scene", sorted(set(packaged_scenes()) - {"paper"}))
def test_every_gate_of_a_scene_has_a_fault_that_turns_it_red(scene):
    assert {gate.id for gate in load_scene(scene).gate} == set().union(*FAULTS_ELSEWHERE[scene].values())


def test_no_quantity_is_without_a_gate_in_a_packaged_scene():
    gates = [gate for name in packaged_scenes() for gate in load_scene(name).gate]
    assert {gate.quantity for gate in gates} == set(QUANTITIES)


def test_every_wave_gate_says_its_damping_and_its_window():
    gates = [gate for name in packaged_scenes() for gate in load_scene(name).gate if gate.quantity.startswith("wave.")]
    assert len(gates) >= 26
    for gate in gates:
        given = gate.arguments
        dampings = [
            f"{word} {given[name]:{form}}"
            for word, name, form in (
                ("loss factor", "loss_factor", "g"),
                ("ratio", "modal_damping", "g"),
                ("dashpots", "joint_dashpot", ".0e"),
            )
            if given.get(name)
        ]
        damping = ", ".join(dampings).replace("e-0", "e-") + " N m s" * ("joint_dashpot" in given) + ", "
        at_a_point = gate.quantity in ("wave.deflection", "wave.receptance") or given.get("of") == "deflection"
        window = "[{} m, {} m]".format(*given["window"]) if "window" in given else "[L/4, 3L/4]"
        x = given.get("x", 0.25)
        place = ("at L/2" if x == 0.25 else f"at {x} m") if at_a_point else window
        assert gate.why.lower().startswith(((damping if dampings else "undamped, ") + place).lower()), gate.id


def verdict(monkeypatch, value, **band):
    """The verdict on a figure that comes out as `value`."""
    from msgspec.structs import replace

    fixed = replace(QUANTITIES["mode.frequency"], evaluate=lambda *given: value)
    monkeypatch.setitem(QUANTITIES, "mode.frequency", fixed)
    gate = Gate(id="g", quantity="mode.frequency", arguments={"model": "analytic", "mode": 3}, why="test", **band)
    return judge(gate, PAPER, workbench_for(PAPER))


@pytest.mark.parametrize(
    ("value", "band", "passed", "share"),
    [
        (10.4, {"expect": 10.0, "within": 0.5}, True, 0.8),
        (9.4, {"expect": 10.0, "within": 0.5}, False, 1.2),
        (10.6, {"expect": 10.0, "within": 0.5}, False, 1.2),
        (2.0, {"at_most": 8.0}, True, 0.25),
        (8.1, {"at_most": 8.0}, False, 8.1 / 8.0),
        (10.0, {"at_least": 8.0}, True, 0.8),
        (7.0, {"at_least": 8.0}, False, 8.0 / 7.0),
        (7.0, {"at_least": 6.0, "at_most": 10.0}, True, 0.5),
        (-5.0, {"at_most": 0.0}, True, None),
        (Bracket(9.0, 12.0), {"expect": 10.0}, True, 1 / 3),
        (Bracket(9.0, 12.0), {"expect": 12.0}, False, 1.0),
        (Bracket(9.0, 12.0), {"expect": 8.0}, False, 2.5 / 1.5),
    ],
)
def test_a_band_judges_from_every_side(monkeypatch, value, band, passed, share):
    found = verdict(monkeypatch, value, **band)
    assert found.passed is passed
    assert bool(found.reason) is not passed
    assert found.share == (None if share is None else pytest.approx(share))


@pytest.mark.parametrize(
    ("value", "band"),
    [
        (nan, {"expect": 10.0, "within": 0.5}),
        (inf, {"at_least": 1.0}),
        (1 + 2j, {"expect": 1.0, "within": 9.0}),
        (10.0, {"expect": 10.0}),
        (Bracket(9.0, 12.0), {"expect": 10.0, "within": 5.0}),
        (Bracket(9.0, 12.0), {"at_most": 50.0}),
    ],
)
def test_a_figure_that_cannot_be_judged_fails(monkeypatch, value, band):
    found = verdict(monkeypatch, value, **band)
    assert not found.passed
    assert found.reason


@pytest.mark.parametrize(
    ("quantity", "arguments", "reason"),
    [
        ("mode.frequncy", {}, "did you mean 'mode.frequency'"),
        ("mode.frequency", {"model": "segmnt", "mode": 1}, "did you mean 'segment'"),
        ("mode.frequency", {"model": "segment", "mode": 9, "count": 9}, "has 8 elastic modes"),
        ("mode.frequency", {"model": "segment", "mode": 9}, "count is missing"),
        (
            "mode.frequency",
            {"model": "fem", "mode": 9, "count": 20, "theory": "rayleigh"},
            "belongs to model = analytic",
        ),
        ("mode.order", {"model": "segment", "mode": 3, "counts": [10, 20]}, "three or more"),
    ],
)
def test_a_gate_that_cannot_be_evaluated_fails_with_the_reason(quantity, arguments, reason):
    gate = Gate(id="g", quantity=quantity, arguments=arguments, expect=1.0, within=1.0, why="test")
    found = judge(gate, PAPER, workbench_for(PAPER))
    assert not found.passed
    assert reason in found.reason
    assert found.reason.startswith("cannot be evaluated: ")


def test_a_model_that_breaks_is_a_failed_gate_not_a_crash(monkeypatch):
    def broken(*_):
        raise np.linalg.LinAlgError("singular")

    monkeypatch.setattr(segment_model, "lowest", broken)
    found = judge(PAPER.gate[0], PAPER, workbench_for(PAPER))
    assert found.reason == (
        "cannot be evaluated: the suite itself fails on it, `verify measure mode.dispersion_error` shows where"
    )


@pytest.mark.parametrize(
    ("band", "message"),
    [
        ({}, "no clear band"),
        ({"expect": 1.0, "at_most": 2.0}, "no clear band"),
        ({"within": 1.0, "at_most": 2.0}, "together with expect"),
        ({"expect": 1.0, "within": 0.0}, "above 0"),
        ({"expect": 1.0, "within": -1.0}, "above 0"),
        ({"expect": nan, "within": 1.0}, "expect = nan"),
        ({"at_least": 3.0, "at_most": 2.0}, "exchange them"),
    ],
)
def test_a_gate_without_a_clear_band_is_no_gate(band, message):
    with pytest.raises(InputError, match=message):
        checked({"id": "g", "quantity": "mode.frequency", "why": "test", **band}, Gate)


def test_a_gate_without_a_reason_is_refused():
    with pytest.raises(InputError, match="why"):
        checked({"id": "g", "quantity": "mode.frequency", "expect": 1.0, "within": 1.0}, Gate)
    with pytest.raises(InputError, match="why"):
        checked({"id": "g", "quantity": "mode.frequency", "expect": 1.0, "within": 1.0, "why": ""}, Gate)


def test_no_sentence_speaks_of_null_or_of_a_class():
    """Neither in the refusal of an argument nor in the list of quantities."""
    from verify.quantities.catalogue import arguments_of, described, quantity

    for name in QUANTITIES:
        for key in ("count", "counts", "model", "mode", "x", "window", "error"):
            for value in (5, "five", [5], -1):
                try:
                    arguments_of(quantity(name), {key: value})
                except InputError as error:
                    assert "null" not in str(error), str(error)
                    assert "<class" not in str(error), str(error)
    assert "<class" not in str(described())


def test_an_endless_figure_beside_a_complex_expectation_is_a_word(monkeypatch):
    assert verdict(monkeypatch, inf, expect=Complex(1.0, 2.0), within=0.5).reason.startswith("measured infinity, and")


def test_expectations_read_as_sentences():
    def words(**band):
        return expectation(Gate(id="g", quantity="q", why="test", **band))

    assert words(expect=-0.25, within=1e-3) == "-0.25 ± 0.001"
    assert words(expect=3.5) == "contains 3.5"
    assert words(at_least=1.0, at_most=2.0) == "at least 1.0, at most 2.0"


def test_gates_that_need_the_same_modes_share_one_solve():
    bench = workbench_for(PAPER, gates_only=True)
    for gate in PAPER.gate:
        judge(gate, PAPER, bench)
    sizes = [(solve.model, solve.count) for solve in bench.solves]
    assert len(sizes) == len(set(sizes))
    planned = {(n.model, n.count) for ask in asks_of(PAPER, gates_only=True) for n in ask.needs}
    assert set(sizes) == planned | {("segment", 41)}  # the size below the first under one per cent
