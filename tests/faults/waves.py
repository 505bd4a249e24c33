"""Faults in driven fields, wave measures and maps. Each takes a monkeypatch and plants itself where the figure comes from."""

import numpy as np
from msgspec import structs

from verify.elements import linear as fem_beam
from verify.exact import harmonic as analytic_harmonic
from verify.models import driven_pencil as harmonic_solvers
from verify.quantities import cases
from verify.segments import linear as segment_model
from verify.waves import driven as waves
from verify.waves import measures as travelling_wave
from verify.waves import operating_point


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
    patch.setattr(travelling_wave, "lifted", lambda beam, slope, turn: 0.0 * slope)


def lower_surface_for_the_upper(patch):
    true = travelling_wave.lifted
    patch.setattr(travelling_wave, "lifted", lambda *given: -true(*given))


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

    def higher(pencil, sharp=False):
        values, vectors = true(pencil, sharp)
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
    true = operating_point.Landscape._known

    def cancelled(self, frequencies, phases):
        gamma, speed = true(self, frequencies, phases)
        if len(frequencies) == 3:  # a point and what lies on both sides
            gamma[1:] = gamma[1:].mean(axis=0)
            gamma[:, 1:] = gamma[:, 1:].mean(axis=1, keepdims=True)
        return gamma, speed

    patch.setattr(operating_point.Landscape, "_known", cancelled)


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
    patch.setattr(segment_model, "joint_readings", segment_model.joint_positions)


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


FAULTS = {
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
        power_of_both_waves_added: {"flux", "energy-flux"},
        singular_values_squared: {"travelling-index"},
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
}
"""By scene: each fault with gates that it turns red."""
