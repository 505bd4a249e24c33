"""Faults that rows of bodies on links, stacks, coils and of refusals by every verb have to find."""

import numpy as np
from faults.stress import limitless, unchecked
from msgspec.structs import replace

from verify.chain import modes as chain_modes
from verify.chain import problems, ride, small_motion, splitting, statics, stepping
from verify.chain.result import ChainMotion
from verify.chain.stretching import ElasticMotion
from verify.chain.system import Rotation
from verify.contact import landing
from verify.elements import shear
from verify.elements import stacks as element_stacks
from verify.exact import error_laws
from verify.exact import modes as exact_modes
from verify.identify import causes, family, fitting, shapes
from verify.judge import bracket, sizing, variants
from verify.models import driven_pencil, eigen, fields
from verify.models.modes import Modes
from verify.motion import simulate, step_size, surface, validity
from verify.segments import attached, carried, loaded, orders
from verify.segments import linear as segment_linear
from verify.segments import stacks as segment_stacks
from verify.waves import absorber, best_phase, devices, imposed, operating_point, poles
from verify.waves import measures as wave_measures


def a_lever_for_every_body(patch):
    patch.setattr(attached, "is_mended", lambda rule, n: False)


def links_taken_for_alike(patch):
    true = attached.places_on

    def alike(*given):
        links, on, even = true(*given)
        return links, on, even | True

    patch.setattr(attached, "places_on", alike)


def slips_that_weigh_twice(patch):
    true = loaded._over_slips
    patch.setattr(loaded, "_over_slips", lambda chain, masses: 2.0 * true(chain, masses))


def turning_links_weigh_more(patch):
    true = loaded._weighed
    patch.setattr(loaded, "_weighed", lambda *given: 1.0001 * true(*given))


def walls_without_excess(patch):
    patch.setattr(carried, "tension_excess", lambda wall: 0.0)


def walls_without_factors(patch):
    true = loaded.bending
    patch.setattr(loaded, "bending", lambda chain, free: 1.01 * true(chain, free))


def loads_in_phase(patch):
    true = ride._on_joints
    patch.setattr(ride, "_on_joints", lambda system, load: abs(true(system, load)))


def flutter_unseen(patch):
    patch.setattr(small_motion, "STRAYED", 1.0)


def resonances_of_the_mode_before(patch):
    true = driven_pencil.refuse_resonance
    patch.setattr(
        driven_pencil, "refuse_resonance", lambda model, hertz, mode, *more: true(model, hertz, mode - 1, *more)
    )


def waves_a_little_short(patch):
    true = fields.wavenumber
    patch.setattr(fields, "wavenumber", lambda *given: (1.0 + 1e-9) * true(*given))


def waves_that_travel_on_any_ground(patch):
    patch.setattr(fields, "travelling_wavenumber", lambda *given: fields.lossless_wavenumber(*given).real)


def forces_felt_a_little_more(patch):
    true = surface._stage

    def felt(*given):
        stage = true(*given)
        return replace(stage, load_rows=lambda position: 1.001 * stage.load_rows(position))

    patch.setattr(surface, "_stage", felt)


def stacks_a_little_heavy(patch):
    for room, name in ((element_stacks, "element_stack"), (segment_stacks, "chain_stack")):
        true = getattr(room, name)

        def heavy(*given, _true=true, **more):
            stack = _true(*given, **more)
            return replace(stack, pencils=replace(stack.pencils, mass=1.0001 * stack.pencils.mass))

        patch.setattr(room, name, heavy)


def duals_a_little_long(patch):
    true = chain_modes._duals
    patch.setattr(chain_modes, "_duals", lambda *given: 1.0001 * true(*given))


def bends_of_whole_turns(patch):
    true = ElasticMotion._elastic
    patch.setattr(ElasticMotion, "_elastic", lambda motion: 1.0001 * true(motion))


def coils_read_across(patch):
    patch.setattr(ChainMotion, "points", lambda motion, x: motion.deflection(x)[:, :, None].repeat(2, axis=2))


def hubs_by_their_offset(patch):
    patch.setattr(Rotation, "constant", property(lambda turn: turn.offset))


def half_the_step(patch):
    true = stepping.step_limit
    patch.setattr(stepping, "step_limit", lambda *given: 0.5 * true(*given))


def landings_a_little_late(patch):
    true = landing.contact_time
    patch.setattr(landing, "contact_time", lambda ratio: 1.0001 * true(ratio))


def a_loss_factor_of_half(patch):
    true = simulate._damping_notes
    patch.setattr(simulate, "_damping_notes", lambda *given: [one.replace("0.0", "0.1") for one in true(*given)])


def margins_of_the_mode_above(patch):
    true = validity.nearest_mode
    patch.setattr(validity, "nearest_mode", lambda *given: true(*given) + 1)


def fields_estimated_by_half(patch):
    true = eigen.field_seconds
    patch.setattr(eigen, "field_seconds", lambda *given, **more: 0.5 * true(*given, **more))


def links_read_after_their_joints(patch):
    true = segment_linear._link_reading
    patch.setattr(
        segment_linear,
        "_link_reading",
        lambda chain, free, x, derivative: true(chain, free, x + 0.01 * chain.unit, derivative),
    )


def slopes_a_little_steep(patch):
    true = Modes.slope
    patch.setattr(Modes, "slope", lambda modes, x: 1.001 * true(modes, x))


def steps_of_a_tenth_missed(patch):
    patch.setattr(step_size, "UNSEEN", 0.1)


def turning_the_other_way(patch):
    true = statics.gyroscopic
    patch.setattr(statics, "gyroscopic", lambda *given: -true(*given))


def a_wall_at_every_end(patch):
    patch.setattr(variants, "has_wall", lambda beam: True)


def orders_of_four(patch):
    patch.setattr(variants.Variant, "order", lambda variant, beam: 4)


def brackets_a_little_wide(patch):
    patch.setattr(bracket.Bracket, "relative_width", property(lambda found: 1.001 * found.upper / found.lower - 1.001))


def sizes_of_one_part_more(patch):
    true = sizing.enough_from

    def more(*given):
        found = true(*given)
        return replace(found, count=found.count + 1)

    patch.setattr(sizing, "enough_from", more)


def ends_unsaid(patch):
    patch.setattr(operating_point, "edge_note", lambda *given: "")


def lists_a_thousandth_of_a_millionth_high(patch):
    true = family.frequencies_hz
    patch.setattr(family, "frequencies_hz", lambda *given: (1.0 + 1e-9 * given[2]) * true(*given))


def whatever_explains_is_believed(patch):
    patch.setattr(causes, "_credible", lambda found: True)


def fields_of_the_order_of_frequencies(patch):
    patch.setattr(orders, "field_order_of", orders.order_of)


def members_of_an_order_more(patch):
    true = family.family

    def declared(*given):
        return tuple(one if one.order is None else replace(one, order=one.order + 1) for one in true(*given))

    patch.setattr(family, "family", declared)


def factors_never_looked_for(patch):
    patch.setattr(fitting, "UNITS", {})


def rigid_motions_judged(patch):
    patch.setattr(shapes, "_elastic", lambda given, beam: (given, ()))


def sizes_of_the_slowest_load(patch):
    true = ride._sized
    patch.setattr(ride, "_sized", lambda system, beam, slider, hertz: true(system, beam, slider, min(hertz, 41.0)))


def phases_that_keep_a_reflection_alone(patch):
    true = best_phase.stationary
    patch.setattr(best_phase, "stationary", lambda *given: 0.0 * true(*given))


def a_dashpot_too_stiff(patch):
    true = absorber.best_dashpot
    patch.setattr(absorber, "best_dashpot", lambda end: (1.1 * true(end)[0], true(end)[1]))


def bends_of_no_shear(patch):
    true = shear.sheared
    patch.setattr(shear, "sheared", lambda xi, derivative: true(xi, min(derivative, 1)))


def drift_by_its_height(patch):
    true = loaded._rigid
    patch.setattr(loaded, "_rigid", lambda chain: true(chain) + np.linspace(0.0, 0.1, len(true(chain)))[:, None])


def areas_of_the_other_sign(patch):
    true = wave_measures.ellipse

    def other(*given):
        ratio, tilt, area = true(*given)
        return ratio, tilt, -area

    patch.setattr(wave_measures, "ellipse", other)


def devices_that_resonate(patch):
    patch.setattr(devices, "DevicesResonanceError", ValueError)


def resonances_a_little_off(patch):
    """The force that moves the held place, which is zero at the bare beam's resonance."""
    true = poles._held

    def off(answers):
        found = true(answers)
        found[..., -1, -1] += 1e-10
        return found

    patch.setattr(poles, "_held", off)


def springs_that_lose(patch):
    true = loaded.lossy_stiffness
    patch.setattr(
        loaded, "lossy_stiffness", lambda chain, *given: true(replace(chain, end_compliances=(0.0, 0.0)), *given)
    )


def spins_that_stop(patch):
    true = splitting._turns

    def stopped(*given):
        turns = true(*given)
        turns[:, np.asarray(given[0]) == 0.0, 1] = 0.0
        return turns

    patch.setattr(splitting, "_turns", stopped)


FAULTS = {
    "stress": {
        springs_that_lose: {"losses-of-the-beam-alone"},
        spins_that_stop: {"chains-that-drift"},
        bends_of_no_shear: {"derivatives-by-differences"},
        drift_by_its_height: {"beams-that-drift"},
        areas_of_the_other_sign: {"ellipses-seen-in-time"},
        unchecked(imposed, "check_held"): {"gaps-of-maps"},
        devices_that_resonate: {"resonances-with-devices"},
        resonances_a_little_off: {"resonances-damped", "held-beside-nodes"},
        steps_of_a_tenth_missed: {"steps-as-chosen"},
        turning_the_other_way: {"turning-forces"},
        a_wall_at_every_end: {"rules-of-a-beam"},
        orders_of_four: {"names-of-rules"},
        brackets_a_little_wide: {"brackets-by-dispersion"},
        sizes_of_one_part_more: {"sizes-side-by-side"},
        ends_unsaid: {"searches-that-end"},
        a_dashpot_too_stiff: {"absorbers"},
        phases_that_keep_a_reflection_alone: {"phases-tried"},
        limitless(error_laws, "MEAN_LIMIT", 2.18766): {"where-errors-turn"},
        lists_a_thousandth_of_a_millionth_high: {"lists-of-members"},
        factors_never_looked_for: {"lists-with-faults"},
        whatever_explains_is_believed: {"lists-of-nothing"},
        members_of_an_order_more: {"orders-of-members"},
        fields_of_the_order_of_frequencies: {"orders-of-fields"},
        rigid_motions_judged: {"shapes-of-sines"},
        sizes_of_the_slowest_load: {"felt-at-the-worst-frequency"},
        limitless(devices, "_ASIDE", 0.0): {"devices-at-turning-ends"},
        a_loss_factor_of_half: {"damping-as-told"},
        margins_of_the_mode_above: {"margins-of-runs"},
        fields_estimated_by_half: {"estimates-as-measured"},
        links_read_after_their_joints: {"links-as-they-stand"},
        slopes_a_little_steep: {"read-by-name"},
        a_lever_for_every_body: {"bodies-on-joints"},
        links_taken_for_alike: {"bodies-on-unlike-links"},
        slips_that_weigh_twice: {"matrices-of-loaded-chains"},
        turning_links_weigh_more: {"matrices-of-loaded-chains"},
        walls_without_excess: {"mended-chains"},
        walls_without_factors: {"readings-of-mended-chains"},
        loads_in_phase: {"riders-felt"},
        flutter_unseen: {"flutter-where-it-is"},
        resonances_of_the_mode_before: {"resonances-by-name"},
        waves_a_little_short: {"wavenumbers-by-states"},
        waves_that_travel_on_any_ground: {"wavenumbers-by-states"},
        forces_felt_a_little_more: {"felt-as-read"},
        stacks_a_little_heavy: {"carrying-beams-at-once-elements", "carrying-beams-at-once-segments"},
        duals_a_little_long: {"modes-of-long-chains"},
        bends_of_whole_turns: {"coils-that-stretch"},
        coils_read_across: {"coils"},
        hubs_by_their_offset: {"hubs-that-stand"},
        half_the_step: {"limits-of-rk4"},
        landings_a_little_late: {"landings"},
        unchecked(segment_linear, "check"): {"refused-by-every-verb"},
        unchecked(exact_modes, "check_mode"): {"refused-numbers"},
        unchecked(problems, "check_links"): {"refused-chain-numbers"},
    }
}
