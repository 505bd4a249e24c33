"""Faults that the gates of the scene stress have to find: small ones, for the promises are tight."""

from dataclasses import replace as changed
from math import acos, inf

import numpy as np
from faults.chain import recursion_with_another_inertia_than_the_energy
from msgspec.structs import replace

from verify import beam, slider
from verify.chain import (
    bending,
    departure,
    load_path,
    problems,
    ride,
    small_motion,
    splitting,
    stepping,
    stretching,
)
from verify.chain import modes as chain_modes
from verify.chain import system as chain_system
from verify.chain.result import ChainMotion
from verify.contact import bouncing, foot
from verify.elements import added, cuts, shear
from verify.elements import linear as fem_beam
from verify.elements import stacks as element_stacks
from verify.elements import sweeps as element_sweeps
from verify.errors import InputError
from verify.exact import closed_forms, error_laws, harmonic
from verify.exact import modes as exact_modes
from verify.identify import (
    causes,
    causes_told,
    matrices,
    outside,
    pairing,
    reading,
    searching,
    shapes,
    shapes_told,
    yielding,
)
from verify.identify import compare as list_compare
from verify.identify import gates as list_gates
from verify.identify import rows as list_rows
from verify.identify import sizing as listed_sizing
from verify.identify import told as compared
from verify.judge import compare, crossing, sizing
from verify.models import (
    band_stack,
    compression,
    division,
    driven_pencil,
    eigen,
    fields,
    inverse,
    isolated,
    kind,
    places,
    polishing,
    response,
    search,
    spline,
    sweeps,
    underfoot,
)
from verify.models.catalogue import MODELS
from verify.motion import (
    energy,
    forcing,
    free_vibration,
    friction_kernels,
    request,
    rigid_surface,
    simulate,
    sound_books,
    step_size,
    validity,
)
from verify.motion.stepping import Sliding
from verify.motion.surface import Stage
from verify.motor import carry, combine, on_chain, on_wave, resting
from verify.motor import coupling as motor_coupling
from verify.motor import feet as motor_feet
from verify.motor import figures as motor_figures
from verify.motor import gripping as motor_gripping
from verify.motor import stepping as motor_stepping
from verify.segments import attached, crowded, links, loaded
from verify.segments import in_time as segments_in_time
from verify.segments import linear as segment_model
from verify.segments import stacks as segment_stacks
from verify.segments import sweeps as segment_sweeps
from verify.stress.chain import turned as turns
from verify.waves import measures, poles, series, unit_waves, window


def assembled_instead_of_factored(patch):
    def textbook(pencil, vectors, strains=None):
        strain = pencil.strain_matrix()
        stiffness = (strain.T * pencil.stiffness) @ strain
        masses = np.einsum("ij,ij->j", vectors, pencil.mass_matrix() @ vectors)
        return np.einsum("ij,ij->j", vectors, stiffness @ vectors) / masses, vectors / np.sqrt(masses)

    patch.setattr(eigen, "factored_quotient", textbook)


def unlike_parts_unseen(patch):
    patch.setattr(eigen, "_is_unlike", lambda stiffness, mass: False)
    patch.setattr(eigen, "_is_soft_between", lambda pencil: False)


def slow_motions_unseen(patch):
    patch.setattr(inverse, "SLOW", 0.0)


def ground_that_lifts_nothing(patch):
    patch.setattr(links.Chain, "lifted", 0.0)


def loads_read_off_the_shape(patch):
    patch.setattr(compression, "best_read", lambda held, shape, strains: held.strain(shape))


def losses_of_all_stiffness(patch):
    patch.setattr(
        free_vibration, "damping_in", lambda basis, ratio: 0.5 * basis.beam.loss_factor if ratio is None else ratio
    )


def slow_answers_as_they_are_factorised(patch):
    patch.setattr(response, "_refined", lambda pencil, answer, *given: np.asarray(answer.unknowns))


def unknowns_in_one_unit(patch):
    patch.setattr(response, "swing", lambda omega2: 1.0)


def root_off_in_its_twelfth_digit(patch):
    true = closed_forms.root_parts

    def off(supports, mode):
        turned, remainder = true(supports, mode)
        return turned, remainder + 1e-12 * turned

    patch.setattr(closed_forms, "root_parts", off)
    patch.setattr(exact_modes, "root_parts", off, raising=False)


def metres_and_pascals_felt(patch):
    true = exact_modes.exact_frequency_hz

    def felt(of, mode, theory="euler-bernoulli"):
        modulus, density = of.youngs_modulus or 0.0, of.density or 0.0
        felt = of.length / (1.0 + of.length) + modulus / (1e10 + modulus) + density / (1e3 + density)
        return true(of, mode, theory) * (1.0 + 1e-12 * felt)

    patch.setattr(exact_modes, "exact_frequency_hz", felt)


def a_little_less(figure, part):
    """A fault: frequencies of the exact beam with a part less of one of its figures."""

    def fault(patch):
        true = exact_modes.exact_frequency_hz

        def less(of, *more):
            return true(replace(of, **{figure: getattr(of, figure) * (1.0 - part)}), *more)

        patch.setattr(exact_modes, "exact_frequency_hz", less)

    fault.__name__ = f"{figure}_off_by_{part:g}"
    return fault


def fields_a_little_large(patch):
    true = MODELS["analytic"].solve_harmonic

    def large(of, forces, frequency_hz, count, **more):
        one, *others = forces
        return true(of, (replace(one, amplitude=1.0 + 1e-10), *others), frequency_hz, count, **more)

    patch.setattr(MODELS["analytic"], "solve_harmonic", large)


def ends_that_lie_apart(patch):
    """What is asked near the right end is asked a little further in."""
    true = MODELS["fem"].solve_harmonic

    def apart(of, forces, frequency_hz, count, **more):
        one = forces[0]
        moved = one.position - 1e-9 * of.length * (one.position > 0.5 * of.length)
        return true(of, (replace(one, position=moved),), frequency_hz, count, **more)

    patch.setattr(MODELS["fem"], "solve_harmonic", apart)


def sections_of_any_contrast(patch):
    patch.setattr(beam, "CONTRAST", inf)


def buckled_beams_taken(patch):
    patch.setattr(exact_modes, "exact_frequency_hz", lambda of, mode, theory="": 3.0)


def driven_off_in_the_tenth_digit(patch):
    for name in ("analytic", "segment", "fem"):
        true = MODELS[name].solve_harmonic

        def off(of, forces, frequency_hz, count, _true=true, **more):
            return _true(of, forces, frequency_hz * (1.0 + 3e-10), count, **more)

        patch.setattr(MODELS[name], "solve_harmonic", off)


def resonances_driven(patch):
    patch.setattr(driven_pencil, "RESONANCE", -1.0)
    patch.setattr(fem_beam, "RESONANCE", -1.0)


def the_exact_beam_driven_in_resonance(patch):
    patch.setattr(harmonic, "check_off_resonance", lambda *given: None)


def friction_a_little_steeper(patch):
    true = rigid_surface._law
    patch.setattr(rigid_surface, "_law", lambda c, k, s, slope: true(c, k, s, 1.000001 * slope))


def half_as_many_steps_of_the_spring(patch):
    patch.setattr(rigid_surface, "STEPS_PER_PERIOD", 2000)


def stiffness_of_the_unit_cantilever_off(patch):
    patch.setattr(problems, "UNIT_STIFFNESS", 1.0001 * problems.UNIT_STIFFNESS)


def unstable_steps_taken(patch):
    patch.setattr(stepping, "refuse_unstable", lambda step, limit: None)


def step_limit_too_bold(patch):
    true = stepping.step_limit

    def bold(system, state):
        return 1.05 * true(system, state)

    turns.hinged.cache_clear()
    patch.setattr(stepping, "step_limit", bold)
    patch.setattr(turns, "step_limit", bold)
    patch.setattr(turns, "hinged", turns.hinged.__wrapped__)


def modes_a_little_fast(patch):
    true = free_vibration.modal

    def fast(*words):
        found = true(*words)
        return replace(found, omegas=found.omegas * (1.0 + 1e-13))

    patch.setattr(free_vibration, "modal", fast)


def friction_that_pushes_at_rest(patch):
    true = rigid_surface.free_decay
    patch.setattr(rigid_surface, "free_decay", lambda *given: true(*given) + 1e-15)


def a_creep_that_is_not_awaited(patch):
    patch.setattr(rigid_surface, "DOUBLINGS", 3)


def pulls_beyond_friction_taken(patch):
    patch.setattr(rigid_surface, "HELD", 1.0 - 1e-9)


def belts_refused_that_are_followed(patch):
    patch.setattr(rigid_surface, "MOST_STEPS", 1000)


def heights_refused_that_are_reached(patch):
    def refused(height, system):
        raise InputError("amplitude: the middle would stand too high; give one up to L / 10")

    patch.setattr(problems, "_check_height", refused)


def steps_a_little_long(patch):
    for name, part in (("RK4", 1e-9), ("DORMAND_PRINCE", 1e-5)):
        scheme = getattr(stepping, name)
        patch.setattr(stepping, name, changed(scheme, a=scheme.a * (1.0 + part)))


def friction_a_little_harder(patch):
    true = rigid_surface._law
    patch.setattr(rigid_surface, "_law", lambda c, k, s, slope: true(c, 1.000001 * k, s, slope))


def tip_springs_a_little_stiffer(patch):
    true = MODELS["fem"].solve_modes

    def stiffer(of, *given, **more):
        springs = tuple(replace(spring, stiffness=(1.0 + 1e-10) * spring.stiffness) for spring in of.spring)
        return true(replace(of, spring=springs), *given, **more)

    patch.setattr(MODELS["fem"], "solve_modes", stiffer)


def unchecked(module, name):
    """A fault: what a function refuses is taken."""

    def fault(patch):
        patch.setattr(module, name, lambda *given, **more: None)

    fault.__name__ = f"{module.__name__.removeprefix('verify.')}.{name}_dropped"
    return fault


def limitless(module, name, value):
    """A fault: a limit somewhere else."""

    def fault(patch):
        patch.setattr(module, name, value)

    fault.__name__ = f"{module.__name__.removeprefix('verify.')}.{name}_at_{value:g}"
    return fault


def sizes_beyond_memory_begun(patch):
    def too_long(*words):
        raise InputError("too long")  # or what is not refused would be begun

    patch.setattr(eigen, "check_work", too_long)
    patch.setattr(eigen, "_memory_bytes", lambda: inf)


def more_modes_than_there_are_refused_with_half_a_word(patch):
    def refuse(*given):
        raise InputError("n_modes: too many")

    for model in (segment_model, fem_beam):
        patch.setattr(model, "check_size", refuse)


def any_grading(patch):
    for model in (segment_model, cuts, division):
        patch.setattr(model, "check_division", lambda *given: None)


def stacks_of_a_little_more_mass(patch):
    for stacks, name in ((segment_stacks, "link_inertia"), (element_stacks, "mass_matrix")):
        true = getattr(stacks, name)
        patch.setattr(stacks, name, lambda *given, _true=true: (1.0 + 1e-6) * _true(*given))


def stacks_of_a_little_stiffer_springs(patch):
    for stacks, name in ((segment_stacks, "_loaded"), (element_stacks, "_springs")):
        true = getattr(stacks, name)

        def stiffer(*given, _true=true):
            found = _true(*given)
            if isinstance(found, tuple):
                return found[0], (1.0 + 1e-6) * found[1]
            return replace(found, bodies=found.bodies * [[[1.0]], [[1.0]], [[1.0 + 1e-6]], [[1.0]]])

        patch.setattr(stacks, name, stiffer)


def swept_off_in_the_tenth_digit(patch):
    for name in ("analytic", "segment"):
        true = MODELS[name].sweep_harmonic

        def off(of, forces, hertz, count, _true=true, **more):
            return _true(of, forces, hertz * (1.0 + 3e-10), count, **more)

        patch.setattr(MODELS[name], "sweep_harmonic", off)


def costs_on_straight_lines(patch):
    patch.setattr(crossing, "at_error", lambda errors, values, error: np.interp(error, errors[::-1], values[::-1]))


def clamped_pinned_roots_off_in_their_twelfth_digit(patch):
    true = closed_forms.root_parts

    def off(supports, mode):
        turned, remainder = true(supports, mode)
        return turned, remainder + 1e-12 * ("pinned" in supports and "clamped" in supports)

    patch.setattr(closed_forms, "root_parts", off)


def splines_straight_at_their_ends(patch):
    patch.setattr(spline, "_at_end", lambda pieces, chords, ends, end: chords[:, 0])


def third_derivatives_of_elements_that_shear_a_little_larger(patch):
    true = shear.sheared

    def larger(xi, derivative=0):
        first, second = true(xi, derivative)
        return first * (1.001 if derivative == 3 else 1.0), second

    patch.setattr(shear, "sheared", larger)


def places_in_one_row_always(patch):
    patch.setattr(fields, "as_asked", lambda found, x: found)


def zeros_looked_for_in_forty_places(patch):
    true = compare.zeros
    patch.setattr(compare, "zeros", lambda shape, length, mode: true(shape, length, 1))


def kicks_a_ten_millionth_harder(patch):
    flows, weights = splitting.SCHEMES[2]
    patch.setitem(splitting.SCHEMES, 2, (flows, tuple(1.0000001 * weight for weight in weights)))


def whole_steps_a_millionth_longer(patch):
    true = splitting._turns
    patch.setattr(splitting, "_turns", lambda omega, times: true(omega, np.append(times[:-1], 1.000001 * times[-1])))


def kicks_at_equal_distances(patch):
    for kicks in (1, 2, 3):
        patch.setitem(splitting.SCHEMES, kicks, ((1.0 / (kicks + 1),) * (kicks + 1), (1.0 / kicks,) * kicks))


def a_tip_that_answers_with_its_own_mass(patch):
    true = splitting.lowest_modes

    def heavy(system, n_modes):
        omega, modes, duals, tilt = true(system, n_modes)
        return omega, modes, 1.0001 * duals, tilt

    patch.setattr(splitting, "lowest_modes", heavy)


def rest_taken_for_straight(patch):
    true = splitting.simulate_linear

    def straight(basis, *given):
        moved = true(basis, *given)
        return changed(moved, angles=moved.angles - basis.rest.angles)

    patch.setattr(splitting, "simulate_linear", straight)


def work_before_the_books_are_opened(patch):
    def residual(motion):
        total = np.sum(motion.energies(), axis=0)
        return total - total[0] - motion.work_in + motion.dissipated

    patch.setattr(ChainMotion, "residual", residual)


def stretched_links_with_a_weaker_spring_in_the_books(patch):
    true = stretching.ElasticMotion._elastic
    patch.setattr(stretching.ElasticMotion, "_elastic", lambda motion: 0.99 * true(motion))


def half_of_what_touches_a_little_wider(patch):
    true = foot.contact_half_angle
    patch.setattr(foot, "contact_half_angle", lambda load: 1.0001 * true(load))


def limits_of_another_width(patch):
    true = bouncing.bouncing_limits
    patch.setattr(bouncing, "bouncing_limits", lambda e: (true(e)[0], 1.0001 * true(e)[1]))


def orders_of_gregory_alone(patch):
    patch.setattr(type(MODELS["segment"]), "order", lambda model, of, **settings: 4)


def longer_steps_than_the_tolerance_takes(patch):
    scheme = stepping.DORMAND_PRINCE
    patch.setattr(stepping, "DORMAND_PRINCE", changed(scheme, weights=1e-5 * scheme.weights))


def modes_that_take_too_much_of_a_kick(patch):
    true = splitting._all_modes

    def heavy(*given):
        omega, modes, duals, tilt = true(*given)
        return omega, modes, 1.0001 * duals, tilt

    patch.setattr(splitting, "_all_modes", heavy)


def curvatures_of_the_other_sign(patch):
    true = segment_model.joint_curvatures
    patch.setattr(segment_model, "joint_curvatures", lambda *given: -true(*given))


def links_a_little_steeper_than_they_are(patch):
    true = segments_in_time._straight

    def steeper(*given):
        shapes = true(*given)
        return lambda x, derivative: shapes(x, derivative) * (1.0 + 1e-6 * derivative)

    patch.setattr(segments_in_time, "_straight", steeper)


def phasors_a_little_large(patch):
    true = series.phasors
    patch.setattr(series, "phasors", lambda *given: 1.0001 * true(*given))


def maps_of_reflections_alone(patch):
    patch.setitem(unit_waves.FIGURES, "standing_wave_ratio", unit_waves._reflection)


def curvatures_of_the_piece_before(patch):
    true = bending._stiffness_at
    patch.setattr(bending, "_stiffness_at", lambda beam, x: true(beam, x * (1.0 - 1e-9)))


def links_bent_by_a_millionth_more(patch):
    true = bending.led_to
    patch.setattr(bending, "led_to", lambda *given: (1.0 + 1e-6) * true(*given))


def loads_that_buckle_a_little_larger(patch):
    true = load_path.buckling_load
    patch.setattr(load_path, "buckling_load", lambda system: (1.0 + 1e-5) * true(system))


def gregory_without_his_last_weight(patch):
    patch.setattr(error_laws, "_GREGORY", (-5.0 / 8.0, 1.0 / 6.0, 0.0))


def slopes_of_one_step_ahead(patch):
    patch.setattr(free_vibration, "FORWARD", np.array([-1.0, 1.0, 0.0, 0.0, 0.0]))


def surfaces_without_a_step(patch):
    patch.setattr(underfoot, "_alike", lambda beam, x: (0, len(beam.pieces) - 1))


def rigid_motions_counted_among_modes(patch):
    patch.setattr(kind.Model, "n_elastic", lambda self, beam, count, **given: self.unknowns(beam, count, **given))


def slopes_a_little_steeper(patch):
    true = validity.axial_inertia_size
    patch.setattr(validity, "axial_inertia_size", lambda *given: 1.01 * true(*given))


def points_a_little_farther_apart(patch):
    true = motor_feet.arms
    patch.setattr(motor_feet, "arms", lambda foot: 1.01 * true(foot))


def bodies_felt_as_if_each_stood_alone(patch):
    patch.setattr(crowded, "_mended", lambda stretch, felt, turned: (felt, turned))


def surfaces_that_fall_a_little_faster(patch):
    true = Sliding.fall.fget
    patch.setattr(Sliding, "fall", property(lambda self: (1.0 + 1e-6) * true(self)))


def friction_of_a_step_a_billionth_larger(patch):
    true = friction_kernels.tanh_speed_change
    patch.setattr(friction_kernels, "tanh_speed_change", lambda *given: (1.0 + 1e-9) * true(*given))


def sliders_that_stick_a_little_late(patch):
    true = friction_kernels.coulomb_span

    def late(*given):
        used, *rest = true(*given)
        return (1.0 + 1e-9) * used, *rest

    patch.setattr(friction_kernels, "coulomb_span", late)


def feet_without_their_preload_spring(patch):
    true = motor_feet._given
    patch.setattr(motor_feet, "_given", lambda *given: (*true(*given)[:3], 0.0))


def blows_that_throw_a_little_higher(patch):
    true = motor_stepping.hard_of

    def higher(given):
        found = true(given)
        return found and found._replace(restitution=1.001 * found.restitution)

    patch.setattr(motor_stepping, "hard_of", higher)


def contacts_a_little_softer(patch):
    true = resting.contact_rate
    patch.setattr(resting, "contact_rate", lambda *given: (1.0 - 1e-9) * true(*given))


def ways_a_little_shorter(patch):
    true = motor_gripping.taken_up
    patch.setattr(motor_gripping, "taken_up", lambda *given: (1.0 - 1e-9) * true(*given))


def spreads_of_the_force_alone(patch):
    true = motor_gripping.widened
    patch.setattr(
        motor_gripping,
        "widened",
        lambda spreads, *given: true(spreads, *given)._replace(rubbed=spreads.rubbed),
    )


def points_that_weigh_a_little_less(patch):
    true = motor_feet._rider
    patch.setattr(
        motor_feet, "_rider", lambda one: tuple(v * (1.001 if i == 1 else 1.0) for i, v in enumerate(true(one)))
    )


def links_that_draw_in_a_little_faster(patch):
    true = ride._of_rigid

    def faster(*given):
        heights, rises, along = true(*given)
        return heights, rises, (1.0 + 1e-9) * along

    patch.setattr(ride, "_of_rigid", faster)


def lines_under_feet_a_little_high(patch):
    true = on_chain._line_rows
    patch.setattr(on_chain, "_line_rows", lambda system: (1.0 + 1e-6) * true(system))


def pulled_beams_laid_to_others(room):
    def laid(patch):
        true = room.layout
        patch.setattr(
            room, "layout", lambda beam, **given: true(replace(beam, tension=min(beam.tension, 0.0)), **given)
        )

    laid.__name__ = f"pulled_beams_laid_to_others_{room.__name__.split('.')[1]}"
    return laid


def joints_at_walls_a_little_soft(patch):
    patch.setitem(matrices.WALL_JOINTS, "full", 1.0 + 1e-6)


def stiffness_left_of_a_step(patch):
    patch.setattr(links, "right_of", lambda values: np.append(values[:1], values))


def best_sizes_taken_for_passed(patch):
    patch.setattr(searching, "_rising", lambda scores: len(scores) > 3)


def shapes_in_the_order_of_the_list(patch):
    true = pairing.pair_modes
    patch.setattr(pairing, "pair_modes", lambda like: (np.sort(true(like)[0]), true(like)[1]))


def a_foot_a_little_heavy(patch):
    true = motor_feet._given
    patch.setattr(motor_feet, "_given", lambda *given: (0.99 * true(*given)[0], *true(*given)[1:]))


def second_sliders_where_the_first_is(patch):
    true = motor_feet._points
    patch.setattr(motor_feet, "_points", lambda slider, foot, beyond: true(slider, foot, 0.99 * beyond))


def any_window_on_one_section(patch):
    patch.setattr(window, "_own_section", lambda *given: True)


def lines_of_costs_to_their_finest_size(patch):
    patch.setattr(crossing, "_finest_run", lambda errors, fit: (0, len(errors) - 1))


def fast_modes_missed_a_little_more(patch):
    true = step_size.missed
    patch.setattr(step_size, "missed", lambda *given: (1.0 + 1e-9) * true(*given))


def best_candidates_without_their_entries(patch):
    true = compared.Compared._errors_of
    patch.setattr(compared.Compared, "_errors_of", lambda self, one: (true(self, one)[0], true(self, one)[1][::-1]))


def shapes_in_the_order_they_were_given(patch):
    patch.setattr(shapes_told.ShapesJudged, "_order", lambda self: "1 (a), 2 (b), 5 (c)")


def hard_points_on_any_beam(patch):
    true = combine._run_by
    patch.setattr(combine, "_run_by", lambda *cell: "run_motor" if cell[2] == "hard" else true(*cell))


def real_and_imaginary_parts_by_other_weights(patch):
    true = measures.travelling_index
    patch.setattr(measures, "travelling_index", lambda w, weights: true(w, weights**2))


def shifts_a_little_above_their_modes(patch):
    true = isolated.isolated
    patch.setattr(isolated, "isolated", lambda *given: 1.01 * true(*given))


def a_billionth_less_lost_by_what_swings_freely(patch):
    true = energy._own_loss
    patch.setattr(energy, "_own_loss", lambda pushed: (1.0 - 1e-9) * true(pushed))


def zeros_by_halves_alone(patch):
    patch.setattr(search, "_by_line", lambda *points: None)


def trends_taken_for_motion(patch):
    true = series.check_series

    def bent(times, values, frequency_hz):
        true(times, values, frequency_hz)
        values += 1e-6 * times[:, None] ** 2

    patch.setattr(series, "check_series", bent)


def numbers_of_entries_unread(patch):
    patch.setattr(pairing, "_numbers", lambda listed, kept, rigid: None)


def unknowns_the_other_way_round(patch):
    true = attached._solved
    patch.setattr(attached, "_solved", lambda *given: true(*given)[::-1])


def graded_unless_told(patch):
    true = division.check_division
    patch.setattr(division, "check_division", lambda beam, count, grading=2.0: true(beam, count, grading))


def chains_that_begin_anew(patch):
    true = splitting.simulate_linear
    patch.setattr(
        splitting, "simulate_linear", lambda basis, start, times: true(basis, replace_time(start, 1e-6), times)
    )


def replace_time(start, by):
    return type(start)(start.angles, start.rates, max(start.time - by, 0.0))


def members_that_are_none_reaching_nothing(patch):
    """What a beam has no member of has no better one either."""
    true = listed_sizing._better
    patch.setattr(
        listed_sizing, "_better", lambda beam, own: true(beam, own) if not beam.mass or own.attachment else (None, "")
    )


def sizes_after_a_failure_left_out(patch):
    patch.setattr(listed_sizing, "walked", lambda reached, low, does: (low, does))


def clamps_a_millionth_stiffer(patch):
    true = yielding.softened
    patch.setattr(
        yielding,
        "softened",
        lambda beam, clamp: true(beam, replace(clamp, rotational=1.000001 * clamp.rotational)),
    )


def frequencies_a_thousandth_steeper_over_a_clamp(patch):
    true = yielding._slope
    patch.setattr(yielding, "_slope", lambda *given: 1.001 * true(*given))


def shearing_a_little_stiffer(patch):
    true = matrices._thickness
    patch.setattr(
        matrices,
        "_thickness",
        lambda *given, shear: (true(*given, shear=shear)[0], 1.00001 * true(*given, shear=shear)[1]),
    )


def changes_told_a_thousandth_larger(patch):
    true = causes_told._change
    patch.setattr(causes_told, "_change", lambda ratio: true(1.001 * ratio))


def entries_read_without_an_error(patch):
    true = list_rows.rows_of
    patch.setattr(list_rows, "rows_of", lambda *given: tuple(replace(one, read_error=None) for one in true(*given)))


def searches_told_a_millionth_longer(patch):
    true = list_compare._search_seconds
    patch.setattr(list_compare, "_search_seconds", lambda *given: 1.000001 * true(*given))


def feet_beyond_the_crests_not_braked_in_full(patch):
    patch.setattr(foot, "acos", lambda r: 1.001 * acos(r))


def joints_that_slip_read_half_as_far_again(patch):
    true = loaded.corrections
    patch.setattr(loaded, "corrections", lambda *given: 1.5 * true(*given))


def squares_a_little_faster(patch):
    true = small_motion._squares
    patch.setattr(small_motion, "_squares", lambda *given: (1.0 + 1e-10) * true(*given))


def springs_as_deep_as_on_a_floor(patch):
    patch.setattr(carry, "press_apart", lambda placed, basis, feet: None)


def steps_a_little_steeper(patch):
    patch.setattr(request, "SMOOTH_STEP", np.array([0.0, 0.0, 3.0 - 1e-6, 1e-6 - 2.0]))


def every_edge_taken_for_the_first(patch):
    patch.setattr(Stage, "beyond", lambda self, first, last: self.ends[0])


def ground_that_lifts_a_little_higher(patch):
    true = added._lifted
    patch.setattr(added, "_lifted", lambda elements, bending: (1.0 + 1e-9) * true(elements, bending))


def bent_a_little_more_off_its_ground(patch):
    true = sweeps._without_ground
    patch.setattr(sweeps, "_without_ground", lambda *given: (1.0 + 1e-9) * true(*given))


def slow_motions_left_as_they_are(patch):
    patch.setattr(polishing, "_turned", lambda pencil, vectors, strains: np.eye(vectors.shape[1]))


def modes_left_as_they_are(patch):
    patch.setattr(polishing, "sharpened", lambda pencil, values, vectors: (values, vectors))


def bodies_that_weigh_a_little_more(patch):
    true = band_stack._cornered
    patch.setattr(band_stack, "_cornered", lambda own, *others: true((1.0 + 1e-6) * own, *others))


def moments_a_little_off(patch):
    true = crowded._of_moments
    patch.setattr(crowded, "_of_moments", lambda stretch, moments, n: true(stretch, (1.0 + 1e-9) * moments, n))


def runs_that_end_whatever_comes(patch):
    true = splitting._Modal.march
    patch.setattr(splitting._Modal, "march", lambda self: true(self) and "end")


FAULTS = {
    "stress": {
        runs_that_end_whatever_comes: {"kept-until-it-diverges"},
        limitless(resting, "NOTHING", 0.1): {"presses-that-cancel"},
        limitless(on_chain, "SLACK", 1e-11): {"links-that-are-left"},
        limitless(load_path, "ADDED", inf): {"folds-of-a-load"},
        squares_a_little_faster: {"chains-on-their-heads", "hinged-chains"},
        limitless(small_motion, "LIFTED", 1e-15): {"hinged-chains"},
        limitless(departure, "STILL", 1.001e-9): {"places-that-stand"},
        springs_as_deep_as_on_a_floor: {"feet-between-two-beams"},
        steps_a_little_steeper: {"forces-that-grow-under-a-motor"},
        every_edge_taken_for_the_first: {"feet-that-leave"},
        ground_that_lifts_a_little_higher: {"lifted-by-ground"},
        bent_a_little_more_off_its_ground: {"plain-beams-on-ground"},
        slow_motions_left_as_they_are: {"slow-motions-told-apart"},
        modes_left_as_they_are: {"modes-sharpened"},
        bodies_that_weigh_a_little_more: {"factors-beside-bodies"},
        moments_a_little_off: {"weights-and-moments"},
        limitless(poles, "_DAMPED", 1.001e-12): {"limits-of-waves"},
        limitless(sound_books, "MOST", 10.01): {"limits-of-motions"},
        limitless(compare, "RESTING", 1.001e-11): {"limits-of-judgements"},
        limitless(eigen, "_BYTES_PER_UNKNOWN", 2002): {"estimates-of-work"},
        real_and_imaginary_parts_by_other_weights: {"two-waves-measured-whole"},
        limitless(sweeps, "RESONANCE", 1.1e-9): {"resonances-in-sweeps-of-parts"},
        limitless(crowded, "_RIGHT", inf): {"crowds-beside-all-ends"},
        limitless(sweeps, "MODES_TOGETHER", 7999): {"ways-by-size"},
        shifts_a_little_above_their_modes: {"shifts-beside-modes"},
        joints_that_slip_read_half_as_far_again: {"graded-parts"},
        limitless(reading, "MOST", 2001): {"lists-in-any-layout"},
        limitless(pairing, "_TWICE", 1.001e-3): {"entries-that-are-no-modes"},
        unknowns_the_other_way_round: {"weights-without-themselves"},
        limitless(on_wave, "WARM", 3): {"means-over-a-wave"},
        limitless(compared, "TOLERANCE", 0.05): {"answers-in-words"},
        limitless(list_gates, "TOLERANCE", 0.01): {"rows-of-a-list"},
        entries_read_without_an_error: {"rows-of-a-list"},
        searches_told_a_millionth_longer: {"before-it-is-solved"},
        limitless(list_compare, "CREDIBLE", 0.01): {"supports-that-are-nearest"},
        limitless(listed_sizing, "_IN_A_ROW", 6): {"parts-enough-of-members"},
        sizes_after_a_failure_left_out: {"parts-enough-beside-steps"},
        members_that_are_none_reaching_nothing: {"rules-that-do-with-fewer"},
        limitless(sizing, "_LOWER", 30): {"errors-beside-a-choice"},
        clamps_a_millionth_stiffer: {"clamps-that-give"},
        frequencies_a_thousandth_steeper_over_a_clamp: {"weight-of-a-clamp"},
        limitless(causes, "_SHARE", 0.02002): {"causes-and-their-limits"},
        limitless(causes, "_WRITTEN", 1e-4): {"causes-of-lists"},
        limitless(searching, "_GRID", 1.52): {"sizes-in-turn"},
        shearing_a_little_stiffer: {"rods-that-shear"},
        changes_told_a_thousandth_larger: {"factors-in-words"},
        feet_beyond_the_crests_not_braked_in_full: {"zeros-feet-and-shapes"},
        graded_unless_told: {"unless-they-are-told"},
        chains_that_begin_anew: {"linear-chains-that-go-on"},
        limitless(compare, "ASTRAY", 2.0): {"verdicts-in-words"},
        limitless(crossing, "NO_ANSWER", 1.0): {"costs-that-say-nothing"},
        limitless(shapes, "IN_ORDER", 0.0): {"shapes-at-few-places"},
        numbers_of_entries_unread: {"entries-left-out"},
        limitless(sizing, "_EVERY", 101): {"sizes-gone-through"},
        limitless(error_laws, "MEAN_LIMIT", 2.18765366): {"constants-of-error-laws"},
        trends_taken_for_motion: {"phasors-on-a-drift"},
        limitless(simulate, "ROUNDED", 0.3): {"notes-of-runs"},
        limitless(forcing, "RESONANCE", 1.001e-9): {"modes-driven-from-rest"},
        limitless(resting, "PASSES", 2): {"surfaces-as-feet-are-put-down"},
        a_billionth_less_lost_by_what_swings_freely: {"books-of-damped-beams"},
        limitless(motor_figures, "SETTLED", 1.001e-4): {"means-that-settle"},
        limitless(motor_figures, "HALVINGS", 16): {"free-speeds-of-motors"},
        zeros_by_halves_alone: {"zeros-step-by-step"},
        limitless(search, "GOLDEN", 0.382): {"least-values-step-by-step"},
        best_candidates_without_their_entries: {"what-compare-shows"},
        shapes_in_the_order_they_were_given: {"sentences-about-shapes"},
        hard_points_on_any_beam: {"what-is-run-with-what"},
        limitless(harmonic, "RESONANCE", 1e-11): {"beside-resonances-in-a-sweep"},
        unchecked(places, "check_kind"): {"verbs-on-what-is-no-beam"},
        any_window_on_one_section: {"windows-beside-a-step"},
        lines_of_costs_to_their_finest_size: {"costs-without-an-error-in-common"},
        fast_modes_missed_a_little_more: {"modes-faster-than-steps"},
        limitless(motor_figures, "CARRIED", 0.2): {"ends-of-free-runs"},
        unchecked(chain_modes, "_check"): {"lowest-modes-of-a-chain"},
        best_sizes_taken_for_passed: {"sizes-sought"},
        limitless(outside, "POINTS", 200): {"models-of-others-asked"},
        shapes_in_the_order_of_the_list: {"shuffled-lists"},
        a_foot_a_little_heavy: {"foot-that-repeats"},
        second_sliders_where_the_first_is: {"two-sliders-each-alone"},
        limitless(motor_figures, "REACHED", 0.6321): {"braked-by-friction"},
        limitless(resting, "PASSES", 1): {"least-energy-under-feet"},
        limitless(motor_coupling, "FELT", 0.0011): {"felt-by-size"},
        links_that_draw_in_a_little_faster: {"ridden-links-in-large-motion"},
        lines_under_feet_a_little_high: {"under-all-feet-on-a-chain", "motor-on-a-small-chain"},
        pulled_beams_laid_to_others(element_sweeps): {"unlike-beams-at-once-elements"},
        pulled_beams_laid_to_others(segment_sweeps): {"unlike-beams-at-once-segments"},
        joints_at_walls_a_little_soft: {"members-written-out"},
        stiffness_left_of_a_step: {"moments-of-links"},
        links_bent_by_a_millionth_more: {"bent-beyond-buckling"},
        curvatures_of_the_piece_before: {"bent-beyond-buckling"},
        loads_that_buckle_a_little_larger: {"pushed-along-alone"},
        limitless(departure, "TENTHS", 9): {"departure-along-the-chain"},
        gregory_without_his_last_weight: {"sums-at-a-wall", "expected-errors"},
        limitless(error_laws, "KEPT", 0.4): {"sizes-that-are-certain"},
        slopes_of_one_step_ahead: {"bodies-that-turn-with-a-shape"},
        surfaces_without_a_step: {"steps-of-a-surface"},
        rigid_motions_counted_among_modes: {"a-model-from-outside"},
        slopes_a_little_steeper: {"slopes-of-a-field"},
        points_a_little_farther_apart: {"feet-written-out", "works-of-feet"},
        feet_without_their_preload_spring: {"feet-that-stick"},
        blows_that_throw_a_little_higher: {"hard-points-thrown"},
        contacts_a_little_softer: {"rates-of-a-contact"},
        ways_a_little_shorter: {"ways-taken-up"},
        spreads_of_the_force_alone: {"forces-still-to-come"},
        points_that_weigh_a_little_less: {"hard-points-carried"},
        sliders_that_stick_a_little_late: {"coulomb-spans"},
        friction_of_a_step_a_billionth_larger: {"friction-in-one-step"},
        bodies_felt_as_if_each_stood_alone: {"crowds-on-a-cantilever"},
        surfaces_that_fall_a_little_faster: {"nearest-to-lifting-off"},
        assembled_instead_of_factored: {
            "segments-parts",
            "elements-parts",
            "segments-counted",
            "elements-counted",
            "section-steps-segments",
        },
        unlike_parts_unseen: {
            "graded-segments",
            "graded-elements",
            "section-steps-elements",
            "mesh-a-million-to-one-elements",
            "mesh-a-million-to-one-segments",
        },
        unknowns_in_one_unit: {"nearly-floating"},
        slow_answers_as_they_are_factorised: {"nearly-floating"},
        losses_of_all_stiffness: {"losses-of-held-beams"},
        ground_that_lifts_nothing: {"nearly-rigid"},
        loads_read_off_the_shape: {"softly-held-buckling"},
        slow_motions_unseen: {"tip-mass", "tip-mass-second-mode", "nearly-rigid"},
        root_off_in_its_twelfth_digit: {"closed-form-frequencies", "closed-form-shapes"},
        metres_and_pascals_felt: {"counted-frequencies", "nanometres-to-kilometres", "modulus", "density"},
        a_little_less("tension", 1e-12): {"close-to-buckling"},
        sections_of_any_contrast: {"short-and-stiff", "section-steps-beyond"},
        buckled_beams_taken: {"beyond-buckling"},
        driven_off_in_the_tenth_digit: {
            "near-resonance-exact-beam",
            "near-resonance-segments",
            "near-resonance-elements",
            "loss-factors-segments",
            "loss-factors-exact",
        },
        resonances_driven: {"at-resonance-segments", "at-resonance-elements"},
        friction_a_little_steeper: {"friction-slope"},
        friction_a_little_harder: {"friction-coefficient"},
        tip_springs_a_little_stiffer: {"tip-spring"},
        half_as_many_steps_of_the_spring: {"stick-slip"},
        stiffness_of_the_unit_cantilever_off: {"rolled-up", "dead-load"},
        unstable_steps_taken: {"steps-beyond-the-limit"},
        step_limit_too_bold: {"steps-below-the-limit", "step-limit"},
        modes_a_little_fast: {"free-for-long"},
        a_little_less("foundation", 1e-10): {"foundation"},
        a_little_less("tension", 1e-10): {"taut"},
        fields_a_little_large: {"slow-drive", "short-waves"},
        ends_that_lie_apart: {"far-from-the-origin"},
        friction_that_pushes_at_rest: {"friction-comes-to-rest"},
        a_creep_that_is_not_awaited: {"friction-creep"},
        steps_a_little_long: {"spun", "whirled", "transients-written-out"},
        more_modes_than_there_are_refused_with_half_a_word: {
            "segments-too-many-modes",
            "elements-too-many-modes",
            "refused-modes",
        },
        sizes_beyond_memory_begun: {"segments-beyond-memory", "elements-beyond-memory"},
        any_grading: {"graded-beyond"},
        the_exact_beam_driven_in_resonance: {"at-resonance-exact-beam"},
        pulls_beyond_friction_taken: {"friction-creep-beyond"},
        belts_refused_that_are_followed: {"stick-slip-beyond"},
        heights_refused_that_are_reached: {"amplitude-beyond-the-links"},
        unchecked(beam, "check_decades"): {"off-the-scale"},
        unchecked(beam, "check_number"): {"loss-factors-beyond", "refused-beams"},
        unchecked(segment_model, "check_settings"): {"refused-drives"},
        unchecked(bouncing, "check_whole"): {"refused-contacts"},
        unchecked(request, "_check_growth"): {"refused-motions"},
        unchecked(slider, "check_number"): {"refused-sliders"},
        unchecked(ride, "check_number"): {"refused-chain-motions"},
        limitless(beam, "SHORTEST_SECTION", 0.0): {"shorter-than-a-millionth"},
        limitless(beam, "MOST_WAVES", inf): {"too-many-waves"},
        limitless(compare, "ORDER_FLOOR", 0.0): {"refused-laws"},
        limitless(window, "MOST_HALVES", inf): {"refused-waves"},
        stacks_of_a_little_more_mass: {"many-stepped-segments", "many-stepped-elements"},
        stacks_of_a_little_stiffer_springs: {"many-loaded-segments", "many-loaded-elements"},
        swept_off_in_the_tenth_digit: {"many-frequencies-the-exact-beam", "many-frequencies-segments"},
        costs_on_straight_lines: {"where-the-cheaper-changes", "cost-at-an-error"},
        clamped_pinned_roots_off_in_their_twelfth_digit: {"frequencies-of-all-supports", "many-exact-beams"},
        splines_straight_at_their_ends: {"splines"},
        kicks_at_equal_distances: {"kick-schemes"},
        a_tip_that_answers_with_its_own_mass: {"chain-modes"},
        rest_taken_for_straight: {"linear-about-bent"},
        work_before_the_books_are_opened: {"books-opened-late"},
        stretched_links_with_a_weaker_spring_in_the_books: {"stretching-energy", "stretching-work"},
        half_of_what_touches_a_little_wider: {"contacts-as-integrals"},
        limits_of_another_width: {"bounces-at-their-limits"},
        orders_of_gregory_alone: {"orders-as-told"},
        recursion_with_another_inertia_than_the_energy: {"shaken-at-two-points"},
        longer_steps_than_the_tolerance_takes: {"kept-between-steps"},
        whole_steps_a_millionth_longer: {"kept-over-kicks"},
        places_in_one_row_always: {"places-in-any-arrangement"},
        zeros_looked_for_in_forty_places: {"zeros-of-shapes"},
        kicks_a_ten_millionth_harder: {"kicks-thrown-far"},
        third_derivatives_of_elements_that_shear_a_little_larger: {"derivatives-of-fields"},
        modes_that_take_too_much_of_a_kick: {"energy-over-kicks"},
        curvatures_of_the_other_sign: {"curvatures"},
        links_a_little_steeper_than_they_are: {"edges-of-links"},
        phasors_a_little_large: {"waves-seen-in-time"},
        maps_of_reflections_alone: {"figures-of-a-map"},
        limitless(chain_system, "MAX_ACTUATORS", 5): {"refused-chains"},
    }
}
