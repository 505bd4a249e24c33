"""Faults that the gates of the scene stress have to find: small ones, for the promises are tight."""

from math import inf

import numpy as np

from verify import beam
from verify.chain import problems, stepping
from verify.elements import linear as fem_beam
from verify.exact import closed_forms
from verify.exact import modes as exact_modes
from verify.models import driven_pencil, eigen
from verify.models.catalogue import MODELS
from verify.motion import free_vibration, rigid_surface
from verify.stress import turns


def assembled_instead_of_factored(patch):
    def textbook(pencil, vectors, strains=None):
        strain = pencil.strain_matrix()
        stiffness = (strain.T * pencil.stiffness) @ strain
        masses = np.einsum("ij,ij->j", vectors, pencil.mass_matrix() @ vectors)
        return np.einsum("ij,ij->j", vectors, stiffness @ vectors) / masses, vectors / np.sqrt(masses)

    patch.setattr(eigen, "factored_quotient", textbook)


def unlike_parts_unseen(patch):
    patch.setattr(eigen, "_is_unlike", lambda stiffness, mass: False)


def heavy_masses_unseen(patch):
    patch.setattr(eigen, "is_heavy", lambda pencil: False)


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
        modulus = of.youngs_modulus or 0.0
        return true(of, mode, theory) * (1.0 + 1e-12 * (of.length / (1.0 + of.length) + modulus / (1e10 + modulus)))

    patch.setattr(exact_modes, "exact_frequency_hz", felt)


def tension_off_in_its_twelfth_digit(patch):
    from msgspec.structs import replace

    true = exact_modes.exact_frequency_hz
    patch.setattr(
        exact_modes,
        "exact_frequency_hz",
        lambda of, *more: true(replace(of, tension=of.tension * (1.0 - 1e-12)), *more),
    )


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
    from msgspec.structs import replace

    true = free_vibration.modal

    def fast(*words):
        found = true(*words)
        return replace(found, omegas=found.omegas * (1.0 + 1e-13))

    patch.setattr(free_vibration, "modal", fast)


FAULTS = {
    "stress": {
        assembled_instead_of_factored: {"segments-parts", "elements-parts", "segments-counted", "elements-counted"},
        unlike_parts_unseen: {
            "graded-segments",
            "graded-elements",
            "section-steps-elements",
            "mesh-a-million-to-one-elements",
        },
        heavy_masses_unseen: {"tip-mass", "tip-mass-second-mode"},
        root_off_in_its_twelfth_digit: {"closed-form-frequencies", "closed-form-shapes"},
        metres_and_pascals_felt: {"counted-frequencies", "nanometres-to-kilometres", "modulus"},
        tension_off_in_its_twelfth_digit: {"close-to-buckling"},
        sections_of_any_contrast: {"short-and-stiff"},
        buckled_beams_taken: {"beyond-buckling"},
        driven_off_in_the_tenth_digit: {
            "near-resonance-exact-beam",
            "near-resonance-segments",
            "near-resonance-elements",
            "loss-factors-segments",
        },
        resonances_driven: {"at-resonance-segments", "at-resonance-elements"},
        friction_a_little_steeper: {"friction-slope"},
        half_as_many_steps_of_the_spring: {"stick-slip"},
        stiffness_of_the_unit_cantilever_off: {"rolled-up", "dead-load"},
        unstable_steps_taken: {"steps-beyond-the-limit"},
        step_limit_too_bold: {"steps-below-the-limit"},
        modes_a_little_fast: {"free-for-long"},
    }
}
