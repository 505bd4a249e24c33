"""Faults in the nonlinear chain, its kernels and its known problems. Each takes a monkeypatch and plants itself where the figure comes from."""

from dataclasses import replace

import numpy as np
from msgspec import structs

from verify.chain import departure as axial_study
from verify.chain import dynamics as chain_dynamics
from verify.chain import problems as chain_studies
from verify.chain import records as chain_records
from verify.chain import splitting as chain_modal
from verify.chain import statics as chain_statics
from verify.chain import system as chain_system
from verify.options import WALLS
from verify.segments import walls as chain_walls


def wall_joint_as_stiff_as_any_other(patch):
    patch.setattr(chain_walls, "_CORRECTIONS", dict.fromkeys(WALLS, ()))


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


def roller_a_tenth_of_a_per_cent_off_the_last_links_end(patch):
    true = chain_modal._flattened

    def off(*given):
        found = true(*given)
        found.loose.links[-1, chain_records.HALF] *= 1.001
        return found

    patch.setattr(chain_modal, "_flattened", off)


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


FAULTS = {
    "chain": {
        wall_joint_as_stiff_as_any_other: {"elastica-deflection", "elastica-shortening", "rollup-gap-of-gregory"},
        links_that_feel_no_inertia_of_the_links_beyond: {"hanging-two-links", "hanging-limit"},
        hanging_links_with_inertia_about_their_ends: {"hanging-one-link", "hanging-two-links"},
        axial_spring_of_half_the_section: {"large-amplitude"},
        clamp_that_turns_without_a_centrifugal_pull: {"turning-slow", "turning-fast", "turning-third-mode"},
        links_pulled_straight_as_if_they_flapped: {"turning-slow", "turning-fast", "turning-third-mode"},
        departures_at_mid_span_wherever_they_are_asked_for: {"departure-at-two-fifths", "departure-at-seven-tenths"},
        recursion_with_another_inertia_than_the_energy: {
            "energy-is-kept",
            "shaken-books",
            "shaken-books-on-a-roller",
            "small-force",
            "ten-newton",
        },
        forces_that_lag_instead_of_lead: {
            "small-force",
            "ten-newton",
            "ten-newton-by-kicks",
            "ten-newton-without-axial-inertia",
        },
        kicks_of_no_strength: {"ten-newton-by-kicks", "links-past-a-right-angle-by-kicks"},
        roller_a_tenth_of_a_per_cent_off_the_last_links_end: {"links-past-a-right-angle-by-kicks"},
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
    "steel-cantilever": {
        wall_joint_as_stiff_as_any_other: {
            "gregory-mode-1",
            "gregory-mode-5",
            "gregory-law",
            "half-wall-order",
            "third-order-wall-order",
            "five-joint-error",
            "curvature-order-of-size",
        },
    },
}
"""By scene: each fault with gates that it turns red."""
