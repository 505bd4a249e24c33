"""Faults in modes, shapes, sections and laws of errors. Each takes a monkeypatch and plants itself where the figure comes from."""

from dataclasses import replace

import numpy as np
from msgspec import structs

from verify.beam import Beam
from verify.elements import added as element_added
from verify.elements import cuts as element_cuts
from verify.elements import in_time as fem_motion
from verify.elements import linear as fem_beam
from verify.elements import mesh as element_mesh
from verify.elements import pencil as element_pencil
from verify.elements import stock
from verify.exact import closed_forms, minors, plate_strip, roots
from verify.judge import compare, sizing, workbench
from verify.models import division, eigen
from verify.quantities.catalogue import QUANTITIES, Quantity
from verify.segments import assembly, links
from verify.segments import carried as chain_carried
from verify.segments import linear as segment_model
from verify.segments import loaded as chain_loaded
from verify.segments import reading as segment_reading
from verify.segments import walls as chain_walls


def link_inertia_left_out(patch):
    patch.setattr(assembly, "link_inertia", lambda mass, length: 0.0 * mass)


def joint_stiffness_doubled(patch):
    true = links.joint_compliance
    patch.setattr(links, "joint_compliance", lambda *given: true(*given) / 2)


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
    patch.setattr(segment_model, "joint_readings", segment_reading.joint_positions)


def shapes_with_unit_amplitude_instead_of_unit_mass(patch):
    true = eigen.factored_quotient

    def rescaled(pencil, vectors, strains=None):
        values, scaled = true(pencil, vectors, strains)
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


def strip_half_as_wide(patch):
    true = plate_strip.stiffening
    patch.setattr(plate_strip, "stiffening", lambda half_width, nu: true(half_width / 2, nu))


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


def gregorys_weights_turned_round(patch):
    patch.setitem(chain_walls._CORRECTIONS, "gregory", (-5 / 8, -1 / 24, 1 / 6))


def orders_of_the_other_walls_exchanged(patch):
    walls = chain_walls._CORRECTIONS
    patch.setattr(
        chain_walls, "_CORRECTIONS", {**walls, "third-order": walls["half"], "five-joint": walls["third-order"]}
    )


def welded_half_forgotten(patch):
    patch.setattr(assembly, "welded_halves", lambda supports: (0, 0))


def welded_halves_at_each_others_ends(patch):
    true = assembly.welded_halves
    patch.setattr(assembly, "welded_halves", lambda supports: true(supports)[::-1])


def mirrored(beam):
    return structs.replace(beam, supports=beam.supports[::-1])


def clamped_end_on_the_wrong_side(patch):
    true_chain, true_free = segment_model.build_chain, element_mesh.free_unknowns
    patch.setattr(segment_model, "build_chain", lambda beam, *given, **more: true_chain(mirrored(beam), *given, **more))
    patch.setattr(element_mesh, "free_unknowns", lambda basis, supports: true_free(basis, supports[::-1]))


def section_order_reversed(patch):
    true = assembly.divide

    def reversed_sections(beam, *given):
        return true(structs.replace(beam, section=beam.section[::-1]), *given)

    patch.setattr(assembly, "divide", reversed_sections)
    patch.setattr(element_cuts, "divide", reversed_sections)


def sections_carried_in_the_wrong_order(patch):
    true = roots.trials

    def reversed_stretches(line):
        return true(structs.replace(line, stretches=line.stretches[::-1], joints=line.joints[::-1]))

    patch.setattr(roots, "trials", reversed_stretches)


def minors_without_their_rest(patch):
    """What a minor keeps of itself, of which cos cosh is the large part, a millionth short."""
    true = minors.carry

    def short(*given):
        by = true(*given)
        return by._replace(both=(1.0 - 1e-6) * by.both)

    patch.setattr(minors, "carry", short)
    patch.setattr(roots, "trials", lambda line: lambda beta_length: minors.trial(line, beta_length**4))


def printed_equation_for_the_series_form(patch):
    true = segment_model.build_chain
    patch.setattr(segment_model, "build_chain", lambda *given, **more: true(*given, **{**more, "joints": "printed"}))


def series_form_for_the_printed_equation(patch):
    true = segment_model.build_chain
    patch.setattr(segment_model, "build_chain", lambda *given, **more: true(*given, **{**more, "joints": "series"}))


def elements_that_ignore_the_step(patch):
    true = element_cuts.divide

    def uniform(beam, *given):
        parts = true(beam, *given)
        return structs.replace(parts, moduli=np.ones_like(parts.moduli))

    patch.setattr(element_cuts, "divide", uniform)


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
    for module in (assembly, element_cuts):
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
    patch.setattr(segment_model, "joint_curvatures", lambda links, *given: true(links, *given) * links.compliances)


def one_rigid_motion_too_few(patch):
    true = Beam.rigid_lines
    patch.setattr(Beam, "rigid_lines", property(lambda beam: true.fget(beam)[:1]))


def nodes_counted_from_the_other_end_of_the_shape(patch):
    true = compare.zeros
    patch.setattr(compare, "zeros", lambda shape, length, mode: true(lambda x: shape(0.99 * x), length, mode))


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


def trial_beam(patch, change):
    """The counted beam is another one than the scene's: `change` takes what stands in line along it."""
    true = roots.line_up
    patch.setattr(roots, "line_up", lambda *given: change(true(*given)))


def springs_left_out_of_the_counting(patch):
    def slack(line):
        joints = tuple(joint._replace(stiffness=0.0, rotational=0.0) for joint in line.joints)
        return structs.replace(line, joints=joints)

    trial_beam(patch, slack)


def foundation_left_out_of_the_counting(patch):
    trial_beam(patch, lambda line: structs.replace(line, foundation=0.0))


def rotary_inertia_of_the_section_left_out_of_the_counting(patch):
    def thin(line):
        return structs.replace(line, stretches=tuple(one._replace(turning=0.0) for one in line.stretches))

    trial_beam(patch, thin)


def rotary_inertia_of_bodies_dropped(patch):
    true = segment_model.build_chain

    def rid(beam):
        return structs.replace(beam, mass=tuple(structs.replace(one, rotary_inertia=0.0) for one in beam.mass))

    patch.setattr(segment_model, "build_chain", lambda beam, *given, **more: true(rid(beam), *given, **more))
    weighed = element_pencil.added_mass
    patch.setattr(
        element_pencil,
        "added_mass",
        lambda elements: weighed(structs.replace(elements, beam=rid(elements.beam))),
    )


def elastic_clamp_without_its_springs_compliance(patch):
    true = chain_carried._added
    patch.setattr(
        chain_carried,
        "_added",
        lambda beam, chain, *given: structs.replace(true(beam, chain, *given), compliances=chain.compliances),
    )


def bodies_on_levers(patch):
    true = segment_model.build_chain
    patch.setattr(segment_model, "build_chain", lambda *given, **more: true(*given, **{**more, "attachment": "lever"}))


def levers_felt_by_four_joints(patch):
    true = segment_model.build_chain
    patch.setattr(
        segment_model, "build_chain", lambda *given, **more: true(*given, **{**more, "attachment": "reciprocal"})
    )


def no_node_under_a_body(patch):
    patch.setattr(element_cuts, "stretches", lambda beam: beam.pieces)


def added_strains_left_out(patch):
    patch.setattr(element_pencil, "added_strains", lambda elements, plain: plain)


def axial_force_on_chords_alone(patch):
    true = element_added.axial_weights
    patch.setattr(
        element_added,
        "axial_weights",
        lambda lengths, *given: true(lengths, *given) * np.repeat([1.0, 0.0, 0.0], len(lengths)),
    )


def tension_of_the_joints_with_the_wrong_sign(patch):
    true = chain_carried._tensioned
    patch.setattr(chain_carried, "_tensioned", lambda beam, parts, tension, *given: true(beam, parts, -tension, *given))


def foundation_not_on_the_links_turns(patch):
    true = chain_loaded._placed

    def across_alone(chain):
        placed = true(chain)
        kept = np.arange(len(placed.stiffness)) // chain.n_segments != 2
        return structs.replace(placed, stiffness=placed.stiffness * kept)

    patch.setattr(chain_loaded, "_placed", across_alone)


def joints_in_series_for_tensioned_ones(patch):
    true = segment_model.build_chain
    patch.setattr(segment_model, "build_chain", lambda *given, **more: true(*given, **{**more, "joints": "series"}))


def slips_with_kappa_forgotten(patch):
    true = chain_carried._softness
    patch.setattr(chain_carried, "_softness", lambda *given: 5.0 / 6.0 * true(*given))


def shear_of_elements_with_kappa_forgotten(patch):
    true = element_pencil.shear_matrix
    patch.setattr(element_pencil, "shear_matrix", lambda basis, shear: true(basis, 6.0 / 5.0 * shear))


def thickness_of_links_left_out(patch):
    true = chain_carried._of_links
    patch.setattr(
        chain_carried,
        "_of_links",
        lambda beam, n, field: true(beam, n, field) * (field != "rotary_inertia"),
    )


def thickness_of_elements_a_hundredth_too_large(patch):
    for name in ("slope_matrix", "rolling_matrix"):
        true = getattr(element_pencil, name)
        patch.setattr(element_pencil, name, lambda basis, weight, true=true: true(basis, 1.01 * weight))


def wall_gives_up_no_more_than_other_joints(patch):
    patch.setattr(chain_carried, "tension_excess", lambda wall: 0.0)


def slipping_joints_with_all_of_their_mass(patch):
    true = chain_carried._slipping
    patch.setattr(chain_carried, "_slipping", lambda *given: structs.replace(true(*given), slip_masses=None))


FAULTS = {
    "paper": {
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
        joint_stiffness_doubled: {
            "segment-dispersion",
            "segment-mode-22",
            "first-under-one-percent",
            "bracket-mode-22",
        },
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
        section_turned_on_its_side: {
            "exact-mode-22",
            "rayleigh-mode-22",
            "paper-mode-22",
            "drive-rule",
            "drive-distance",
        },
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
        strip_half_as_wide: {"plate-mode-22"},
        wavelength_for_its_quarter: {"drive-distance"},
        mean_instead_of_root_mean_square_of_mode_numbers_one_too_high: {"drive-rule"},
        bracket_of_one_model_alone: {"bracket-mode-22", "bracket-mode-5", "mean-mode-22"},
        order_from_the_wrong_logarithm: {"segment-order", "fem-order", "mean-order"},
        error_relative_to_the_computed_frequency_with_its_sign_lost: {"segment-mode-22", "fem-mode-22", "mean-mode-22"},
        count_one_too_high: {"first-under-one-percent"},
    },
    "paper-slider": {
        lumped_element_mass: {"slider-elements", "slider-order-fem", "beam-elements"},
    },
    "chain": {
        joint_stiffness_doubled: {
            "elastica-deflection",
            "elastica-shortening",
            "rollup-closes",
            "rollup-gap-of-gregory",
            "small-force",
        },
    },
    "paper-wave": {
        lumped_element_mass: {"fem-49-ratio", "fem-ratio-order", "fem-ellipse-order", "fem-best-frequency", "mid-span"},
        link_inertia_left_out: {"segment-49-ratio", "segment-best-frequency", "segment-ratio-order"},
        section_turned_on_its_side: {"swr-law", "envelope", "best-frequency"},
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
    "instrument-arm": {
        springs_left_out_of_the_counting: {"exact-mode-1", "exact-mode-4", "exact-node", "segment-error", "fem-error"},
        rotary_inertia_of_bodies_dropped: {
            "segment-order",
            "segment-error",
            "lever-error",
            "levers-at-40",
            "fem-error",
            "fem-order",
            "elements-at-40",
        },
        elastic_clamp_without_its_springs_compliance: {
            "segment-order",
            "segment-error",
            "segment-node",
            "half-clamp-order",
            "third-order-clamp-order",
        },
        bodies_on_levers: {"segment-order", "segment-error", "segment-node", "links-for-a-tenth-of-a-per-cent"},
        levers_felt_by_four_joints: {"lever-order", "lever-error", "levers-at-40"},
        no_node_under_a_body: {"fem-order", "fem-error", "elements-at-40"},
        added_strains_left_out: {"fem-stiffness"},
        gregorys_weights_turned_round: {"segment-order", "segment-error"},
        orders_of_the_other_walls_exchanged: {"third-order-clamp-order"},
        joints_read_raw: {"segment-node"},
        nodes_counted_from_the_other_end_of_the_shape: {"exact-node", "segment-node"},
    },
    "taut-strip": {
        foundation_left_out_of_the_counting: {
            "exact-mode-1",
            "exact-mode-10",
            "series-error",
            "fem-error",
            "fem-order",
        },
        foundation_not_on_the_links_turns: {"series-error", "tensioned-error", "tensioned-order"},
        tension_of_the_joints_with_the_wrong_sign: {"tensioned-error", "tensioned-order", "tensioned-count"},
        joints_in_series_for_tensioned_ones: {"tensioned-error", "tensioned-order", "tensioned-count"},
        axial_force_on_chords_alone: {"fem-error", "fem-error-10", "fem-order", "fem-stiffness"},
        link_inertia_left_out: {"series-error", "tensioned-error", "tensioned-order"},
        lumped_element_mass: {"fem-error", "fem-error-10"},
        order_from_the_wrong_logarithm: {"series-order", "tensioned-order", "graded-order", "fem-order"},
        grading_that_stretches_the_last_part_alone: {"graded-order"},
        count_one_too_high: {"series-count", "tensioned-count"},
    },
    "thick-bar": {
        rotary_inertia_of_the_section_left_out_of_the_counting: {
            "exact-mode-1",
            "exact-mode-4",
            "rayleigh-mode-2",
            "theory-mode-2",
            "slipping-error",
            "fem-error",
            "fem-rayleigh-order",
        },
        slips_with_kappa_forgotten: {
            "slipping-error",
            "slipping-order",
            "mended-error",
            "mended-order",
            "series-count",
        },
        thickness_of_links_left_out: {"slipping-error", "slipping-order", "rolling-order", "rolling-mended-order"},
        joints_in_series_for_tensioned_ones: {"mended-error", "mended-error-2", "mended-order", "rolling-mended-order"},
        wall_gives_up_no_more_than_other_joints: {"mended-error", "mended-error-2", "mended-order"},
        slipping_joints_with_all_of_their_mass: {"mended-error", "mended-error-2", "mended-order"},
        shear_of_elements_with_kappa_forgotten: {"fem-error", "fem-order"},
        thickness_of_elements_a_hundredth_too_large: {"fem-error", "fem-order", "fem-rayleigh-order"},
    },
}
"""By scene: each fault with gates that it turns red."""
