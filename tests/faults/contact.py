"""Faults in contact's closed forms and in absorbing devices. Each takes a monkeypatch and plants itself."""

from math import cos, pi, sqrt

from verify.contact import bouncing, landing, layer
from verify.waves import absorber


def contact_as_deep_everywhere(patch):
    patch.setattr(layer, "pressed", lambda s, phi: s * (1.0 - cos(phi)))


def layer_that_never_slips(patch):
    patch.setattr(layer, "_slips_at", lambda s, phi, r, epsilon, c: (phi, 0))


def a_stuck_layer_runs_as_fast_as_its_edge(patch):
    patch.setattr(layer, "sin", lambda s: s * cos(s))


def power_taken_for_force(patch):
    patch.setattr(layer, "carried", layer.pressed)


def landing_where_it_left(patch):
    patch.setattr(bouncing, "leaving_phase", lambda ratio: 1.0 / ratio)


def a_dashpot_that_pulls(patch):
    """Until the spring is slack; above zeta = 1 it never is, and time is up."""
    patch.setattr(landing, "contact_time", lambda zeta: pi / sqrt(1.0 - zeta**2) if zeta < 1.0 else 100.0)


def a_dashpot_against_all_of_critical(patch):
    true = landing.damping_ratio
    patch.setattr(landing, "damping_ratio", lambda *given: 2.0 * true(*given))


def near_field_of_the_pin_forgotten(patch):
    true = absorber.beam_impedance

    def without(beam, frequency_hz, distance):
        mobility = 1.0 / true(beam, frequency_hz, distance)
        return 1.0 / (mobility + 0.01j * abs(mobility))

    patch.setattr(absorber, "beam_impedance", without)


def reflection_of_a_string(patch):
    patch.setattr(absorber, "reflection", lambda z, own: abs(z - own) / abs(z + own))


def device_a_quarter_too_stiff(patch):
    true = absorber.field_with_device
    patch.setattr(absorber, "field_with_device", lambda *given: true(*given[:4], 1.25 * given[4]))


FAULTS = {
    "driving-layer": {
        contact_as_deep_everywhere: {"no-load-speed", "force-at-half-speed", "efficiency", "stall-force-with-give"},
        layer_that_never_slips: {"no-load-speed-with-give", "stall-force-with-give"},
        a_stuck_layer_runs_as_fast_as_its_edge: {"no-load-speed-stuck"},
        power_taken_for_force: {"efficiency"},
        landing_where_it_left: {"landing", "a-flight-of-one-period"},
        a_dashpot_that_pulls: {"restitution-of-a-dashpot", "restitution-of-a-strong-dashpot"},
        a_dashpot_against_all_of_critical: {"restitution-of-a-strong-dashpot"},
    },
    "absorbing-end": {
        near_field_of_the_pin_forgotten: {"matched-impedance", "best-dashpot-alone"},
        reflection_of_a_string: {"twice-the-resistance"},
        device_a_quarter_too_stiff: {
            "two-hundred-hertz-below",
            "exact-beam-with-its-device",
            "segments-with-a-device",
            "elements-with-a-device",
        },
    },
}
"""By scene: each fault with gates that it turns red."""
