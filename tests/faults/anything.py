"""Faults that rows of beams with anything on them, written-out parts, moved chains and driven waves have to find."""

from dataclasses import replace as changed
from types import SimpleNamespace

from faults.driven import rotary_inertia_of_no_share
from faults.stress import unchecked
from msgspec.structs import replace

from verify.chain import dynamics, held_kernels, statics, stepping
from verify.chain.small_motion import Linearisation
from verify.contact import foot
from verify.device import Device
from verify.exact import buckling, closed_forms, error_laws, in_time, roots, spans
from verify.exact import modes as exact_modes
from verify.judge import extended_precision, sizing
from verify.models import sweeps
from verify.models.catalogue import MODELS
from verify.models.fields import HarmonicField
from verify.motion import free_vibration, simulate, step_size
from verify.segments import turned
from verify.stress.modes import any_beam as anything
from verify.stress.refused import runs as refused_runs
from verify.waves import driven, imposed, lumped, operating_point
from verify.waves.found import TwoWaves
from verify.waves.medium import Medium


def states_by_too_few_terms(patch):
    patch.setattr(spans, "_TERMS", 9)


def rigid_motions_uncounted(patch):
    true = roots.modes_below
    patch.setattr(roots, "modes_below", lambda beam, *given: true(beam, *given) - beam.rigid_motions)


def counted_frequencies_a_little_high(patch):
    true = exact_modes.exact_frequency_hz
    patch.setattr(exact_modes, "exact_frequency_hz", lambda *given: (1.0 + 1e-10) * true(*given))
    patch.setattr(anything, "exact_frequencies", anything.exact_frequencies.__wrapped__)


def loads_a_little_high(patch):
    true = buckling.buckling_load
    patch.setattr(buckling, "buckling_load", lambda beam: (1.0 + 1e-10) * true(beam))


def parts_a_little_off(patch):
    """What elements and links answer is off in its seventh digit."""
    for name in ("fem", "segment"):
        model = MODELS[name]
        modes, field, sweep, load, units = (
            getattr(model, verb)
            for verb in ("solve_modes", "solve_harmonic", "sweep_harmonic", "buckling_load", "unit_responses")
        )

        def slower(*given, _true=modes, **more):
            found = _true(*given, **more)
            return replace(found, frequencies_hz=(1.0 - 1e-7) * found.frequencies_hz)

        def later(of, forces, hertz, *given, _true=field, **more):
            return _true(of, forces, (1.0 + 1e-6) * hertz, *given, **more)

        def swept_later(of, forces, hertz, *given, _true=sweep, **more):
            return _true(of, forces, (1.0 + 1e-6) * hertz, *given, **more)

        def lower(*given, _true=load, **more):
            return (1.0 - 1e-7) * _true(*given, **more)

        def weaker(*given, _true=units, **more):
            return (1.0 - 1e-7) * _true(*given, **more)

        for verb, fault in (
            ("solve_modes", slower),
            ("solve_harmonic", later),
            ("sweep_harmonic", swept_later),
            ("buckling_load", lower),
            ("unit_responses", weaker),
        ):
            patch.setattr(model, verb, fault)


def stacked_values_a_little_high(patch):
    true = sweeps.lowest_of_each

    def high(*given):
        values, sure = true(*given)
        return (1.0 + 1e-10) * values, sure

    patch.setattr(sweeps, "lowest_of_each", high)


def chains_that_answer_a_little_more(patch):
    accelerations, energies = dynamics.accelerations, dynamics.energies
    patch.setattr(dynamics, "accelerations", lambda *given: 1.000001 * accelerations(*given))
    patch.setattr(dynamics, "energies", lambda *given: tuple(1.000001 * one for one in energies(*given)))


def rest_by_one_step(patch):
    patch.setattr(statics, "TOLERANCE", 1e9)
    patch.setattr(statics, "SETTLED", 1e9)


def links_a_little_heavier_about_rest(patch):
    true = dynamics.mass_matrix
    patch.setattr(dynamics, "mass_matrix", lambda *given: 1.0001 * true(*given))


def growth_taken_for_swing(patch):
    true = Linearisation.squares
    patch.setattr(Linearisation, "squares", lambda about: abs(true(about)))


def a_start_that_is_counted(patch):
    true = stepping.ChainStatistics
    patch.setattr(stepping, "ChainStatistics", lambda **told: true(**(told | {"evaluations": told["evaluations"] + 1})))


def conditions_missed(patch):
    scheme = stepping.DORMAND_PRINCE
    patch.setattr(stepping, "DORMAND_PRINCE", changed(scheme, c=scheme.c * (1.0 + 1e-9)))


def waves_that_run_the_other_way(patch):
    true = lumped._waves_of
    patch.setattr(lumped, "_waves_of", lambda *given: true(*given)[::-1])


def every_wave_forwards(patch):
    patch.setattr(TwoWaves, "direction", property(lambda waves: 1))


def power_by_bending_alone(patch):
    patch.setattr(Medium, "beside_shear", lambda medium, omega: 0.0)


def turns_of_running_waves(patch):
    """Of every section that shears, near forces and ends too."""
    true = HarmonicField.turns

    def turns(field, x, derivative):
        if field.theory != "timoshenko":
            return true(field, x, derivative)
        return Medium(field.beam, field.theory).turn(field.omega) * field.shapes(x, derivative + 1)

    patch.setattr(HarmonicField, "turns", turns)


def links_turned_at_walls(patch):
    """As the corrections of a wall's joints turn them."""
    patch.setattr(turned, "_smoothed", lambda chain, free: 0.0)


def losses_of_bending_alone(patch):
    true = driven._lost
    patch.setattr(driven, "_lost", lambda field, *given: true(replace(field, theory="rayleigh"), *given))


def devices_that_turn_freely(patch):
    patch.setattr(Device, "turning_impedance", lambda device, omega: 0.0)


def displacements_in_phase(patch):
    patch.setattr(imposed, "phasor", lambda drive: complex(drive.amplitude))


def phases_a_little_early(patch):
    true = operating_point.phases_to_try
    patch.setattr(operating_point, "phases_to_try", lambda *given: 0.97 * true(*given))


def quiet_a_little_high(patch):
    true = operating_point.quietest

    def high(*given):
        found = true(*given)
        return replace(found, x=found.x * (1.0 + 1e-5))

    patch.setattr(operating_point, "quietest", high)


def one_part_more(patch):
    true = sizing.between
    patch.setattr(sizing, "between", lambda *given: true(*given) + 1)


def guesses_three_parts_high(patch):
    true = sizing.count_guess
    patch.setattr(sizing, "count_guess", lambda *given: true(*given) + 3)


def errors_expected_a_little_larger(patch):
    true = error_laws.expected_error
    patch.setattr(error_laws, "expected_error", lambda *given: 1.001 * true(*given))


def a_leading_law_a_little_larger(patch):
    true = error_laws.leading_error
    patch.setattr(error_laws, "leading_error", lambda *given: 1.05 * true(*given))


def a_little_more_damping_from_rest(patch):
    true = simulate.stages_from_rest

    def damped(basis, forces, omega, damping, *given):
        return true(basis, forces, omega, 1.001 * damping, *given)

    patch.setattr(simulate, "stages_from_rest", damped)


def let_go_a_little_fast(patch):
    true = free_vibration.modal

    def fast(*given):
        found = true(*given)
        return replace(found, omegas=found.omegas * (1.0 + 1e-6))

    patch.setattr(free_vibration, "modal", fast)


def every_section_as_the_first(patch):
    patch.setattr(in_time, "_ratio", lambda beam, x: 1.0 + 0.0 * x)


def cut_off_under_forces_in_phase(patch):
    patch.setattr(in_time, "phasor", lambda force: complex(force.amplitude))


def waves_a_little_long(patch):
    from verify.quantities import modes

    true = closed_forms.quarter_wavelength
    patch.setattr(closed_forms, "quarter_wavelength", lambda *given: (1.0 + 1e-12) * true(*given))
    patch.setattr(modes, "quarter_wavelength", closed_forms.quarter_wavelength, raising=False)


def steps_that_miss_a_little_more(patch):
    true = step_size.missed
    patch.setattr(step_size, "missed", lambda *given: 1.01 * true(*given))


def pivots_of_a_fifth(patch):
    patch.setattr(dynamics, "PIVOT_LOSS", 0.2)


def loops_that_keep_their_pivots(patch):
    patch.setattr(held_kernels, "repivot", SimpleNamespace(py_func=lambda *given: False))


def feet_a_little_high(patch):
    for name in ("height_swing", "standing_height"):
        true = getattr(foot, name)
        patch.setattr(foot, name, lambda given, _true=true: _true(given) + 0.01)


def a_judge_of_heavier_matrices(patch):
    true = extended_precision.count_below
    patch.setattr(extended_precision, "count_below", lambda stiffness, mass, value: true(stiffness, mass, value * 2))


def a_judge_whose_guided_links_turn_at_the_wall(patch):
    true = extended_precision._weight

    def weight(supports, n, joint):
        return true(("pinned", supports[1]) if supports[0] == "guided" else supports, n, joint)

    patch.setattr(extended_precision, "_weight", weight)


FAULTS = {
    "driven-cantilever": {waves_a_little_long: {"quarter-wavelength"}},
    "stress": {
        states_by_too_few_terms: {"fields-of-any-beam", "shapes-of-any-beam", "devices-in-states"},
        rigid_motions_uncounted: {"counts-of-any-beam"},
        counted_frequencies_a_little_high: {"frequencies-of-any-beam"},
        loads_a_little_high: {"buckling-of-any-beam"},
        parts_a_little_off: {
            "modes-of-elements-written-out",
            "modes-of-links-written-out",
            "fields-of-elements-written-out",
            "fields-of-links-written-out",
            "links-beside-their-ends",
            "elements-that-shear-written-out",
            "unit-forces-of-elements",
            "buckling-of-elements-written-out",
            "buckling-of-links-written-out",
        },
        stacked_values_a_little_high: {"nine-beams-at-once-elements", "nine-beams-at-once-segments"},
        chains_that_answer_a_little_more: {"accelerations-written-out", "energies-written-out"},
        rest_by_one_step: {"rest-written-out"},
        links_a_little_heavier_about_rest: {"small-motion-written-out"},
        growth_taken_for_swing: {"chains-upright"},
        a_start_that_is_counted: {"accelerations-counted"},
        conditions_missed: {"runge-kutta-conditions"},
        waves_that_run_the_other_way: {"waves-of-two-modes", "local-waves"},
        every_wave_forwards: {"which-way"},
        power_by_bending_alone: {"power-by-every-theory"},
        turns_of_running_waves: {"turns-of-exact-beam", "turns-of-elements"},
        links_turned_at_walls: {"turns-of-segments"},
        losses_of_bending_alone: {"power-lost-by-shear"},
        devices_that_turn_freely: {"devices-in-states"},
        displacements_in_phase: {"places-held"},
        phases_a_little_early: {"fastest-crests"},
        quiet_a_little_high: {"quietest-drive"},
        one_part_more: {"sizes-between-pins", "sizes-where-errors-change-sign", "sizes-from-a-guess"},
        guesses_three_parts_high: {"sizes-cost-two-solves"},
        errors_expected_a_little_larger: {"errors-expected"},
        a_leading_law_a_little_larger: {"errors-expected-at-clamps"},
        a_little_more_damping_from_rest: {"beams-driven-in-time", "beams-started-softly"},
        let_go_a_little_fast: {"beams-let-go"},
        rotary_inertia_of_no_share: {"beams-let-go"},
        every_section_as_the_first: {"modes-to-move-in"},
        cut_off_under_forces_in_phase: {"modes-cut-off"},
        steps_that_miss_a_little_more: {"speed-that-steps-miss"},
        pivots_of_a_fifth: {"pivots-kept"},
        loops_that_keep_their_pivots: {"pivots-kept"},
        feet_a_little_high: {"short-feet", "long-feet"},
        a_judge_of_heavier_matrices: {"judge-of-eigenvalues"},
        a_judge_whose_guided_links_turn_at_the_wall: {"judge-of-eigenvalues"},
        unchecked(imposed, "check_held"): {"refused-once-solved"},
        unchecked(refused_runs, "check_count"): {"refused-sizes-and-chains"},
    },
}
