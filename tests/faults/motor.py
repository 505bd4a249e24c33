"""Faults in a slider that may leave the beam, and in friction on its own. Each takes a monkeypatch and plants itself."""

import faults.motion as friction
from msgspec import structs

from verify.motor import feet, figures, outcome, stepping


def friction_a_tenth_larger(patch):
    true = feet._rider
    patch.setattr(feet, "_rider", lambda one: (1.1 * true(one)[0], *true(one)[1:]))


def surface_lever_half_as_long(patch):
    true = feet.rubbing_of

    def shorter(slider, beam):
        found = true(slider, beam)
        return found._replace(half=0.5 * found.half)

    for module in (feet, stepping):
        patch.setattr(module, "rubbing_of", shorter)


def springs_twice_as_stiff(patch):
    true = feet._points

    def stiffer(*given):
        sheet = true(*given)
        sheet[:, 2] *= 2.0
        return sheet

    patch.setattr(feet, "_points", stiffer)


def give_along_the_surface_doubled(patch):
    true = feet._points

    def softer(*given):
        sheet = true(*given)
        sheet[:, 4] *= 0.5
        return sheet

    patch.setattr(feet, "_points", softer)


def preload_a_tenth_less(patch):
    true = feet._given
    patch.setattr(feet, "_given", lambda *given: (*true(*given)[:2], 0.9 * true(*given)[2], true(*given)[3]))


def one_block_of_a_bounce_taken_for_its_mean(patch):
    true = figures._in_blocks

    def taken(*given):
        found, run = true(*given)
        return structs.replace(found, unsettled=()), run

    patch.setattr(figures, "_in_blocks", taken)


def what_sticks_taken_for_what_touches(patch):
    true = figures._found

    def exchanged(*given):
        found = true(*given)
        return structs.replace(found, contact_share=found.stuck_share, stuck_share=found.contact_share)

    patch.setattr(figures, "_found", exchanged)


def power_of_half_the_speed(patch):
    patch.setattr(figures.AtSpeed, "power", property(lambda self: 0.5 * self.force * self.speed))


def under_way_at_half_the_speed(patch):
    patch.setattr(figures, "REACHED", 0.5)


def dashpots_left_out_of_the_books(patch):
    true = outcome.ledger

    def without(*given):
        books = true(*given)
        return structs.replace(books, residual=books.residual + books.damped)

    patch.setattr(outcome, "ledger", without)


FAULTS = {
    "preloaded-motor": {
        friction_a_tenth_larger: {"stall-exact", "stall-segments", "stall-elements", "force-at-three-quarters"},
        surface_lever_half_as_long: {
            "no-load-exact",
            "no-load-elements",
            "no-load-segments",
            "free-speed",
            "wear-standing-still",
        },
        springs_twice_as_stiff: {"share-of-contact", "efficiency-at-three-quarters"},
        preload_a_tenth_less: {"preload-carried", "stall-exact", "bounce-carries-its-preload"},
        one_block_of_a_bounce_taken_for_its_mean: {"bounce-carries-its-preload"},
        what_sticks_taken_for_what_touches: {"nothing-sticks", "share-of-contact"},
        power_of_half_the_speed: {"power-at-three-quarters", "efficiency-at-three-quarters"},
        under_way_at_half_the_speed: {"start-time"},
        dashpots_left_out_of_the_books: {"books"},
    },
    "multi-contact-slider": {
        friction_a_tenth_larger: {"stall-with-give", "stall-with-give-segments", "coulomb-points-to-layer"},
        surface_lever_half_as_long: {"no-load-with-give", "coulomb-points-to-layer"},
        springs_twice_as_stiff: {"both-beams-press", "points-that-touch", "giving-points-to-layer"},
        give_along_the_surface_doubled: {
            "stall-with-give",
            "force-with-give",
            "giving-points-to-layer",
            "order-of-points",
        },
        what_sticks_taken_for_what_touches: {"points-that-touch"},
    },
    "stick-slip-belt": {
        friction.friction_that_pushes: {"decrement", "slow-belt-sticks", "middling-belt-slips"},
        friction.static_friction_for_kinetic: {
            "slow-belt-sticks",
            "slow-belt-slips",
            "middling-belt-sticks",
            "middling-belt-slips",
            "fast-belt-sticks",
            "fast-belt-slips",
        },
        friction.friction_under_another_gravity: {"decrement", "tanh-decays", "tanh-creeps"},
        friction.friction_of_half_the_slope: {"tanh-decays", "tanh-creeps"},
    },
}
"""By scene and fault, the gates that it turns red."""
