"""Faults in contact's closed forms and in absorbing devices. Each takes a monkeypatch and plants itself."""

from math import cos, pi, sqrt

from verify.contact import bouncing, landing, layer
from verify.device import Device
from verify.waves import absorber, devices, lumped


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
    true = absorber._moved

    def without(*given):
        moved = true(*given)
        return moved - 0.01 * abs(moved)

    patch.setattr(absorber, "_moved", without)


def reflection_of_a_string(patch):
    patch.setattr(absorber, "reflection", lambda z, end: abs(z - end.own) / abs(z + end.own))


def device_a_quarter_too_stiff(patch):
    true = Device.impedance
    patch.setattr(Device, "impedance", lambda self, omega: 1.25 * true(self, omega))


def device_that_turns_without_its_inertia(patch):
    patch.setattr(Device, "turning_impedance", lambda self, omega: complex(self.rotational_dashpot))


def springs_against_turning_half_as_stiff(patch):
    true = devices._sprung
    patch.setattr(devices, "_sprung", lambda beam, position, spring: true(beam, position, 0.5 * spring))


def a_pin_taken_for_a_free_end(patch):
    patch.setitem(absorber._ENDS, "pinned", absorber._ENDS["free"])


def modes_that_swing_together(patch):
    patch.setattr(lumped.TwoModes, "_second", property(lambda self: complex(self.ratio)))


def curvature_forgotten_in_one_wave(patch):
    """Of both waves the even part alone is taken from the deflection as it is."""

    def waves(shapes, k, x):
        even, odd = shapes(x, 0), 0.5j * (shapes(x, 1) - shapes(x, 3) / k**2) / k
        return 0.5 * (even + 1.1 * odd), 0.5 * (even - 1.1 * odd)

    patch.setattr(lumped, "_waves_of", waves)


FAULTS = {
    "stress": {layer_that_never_slips: {"layers-that-give"}},
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
            "wave-with-its-device",
            "wave-with-its-device-on-segments",
            "wave-with-its-device-on-elements",
            "power-that-runs-to-the-device",
        },
        device_that_turns_without_its_inertia: {
            "exact-beam-against-turning",
            "segments-against-turning",
            "elements-against-turning",
        },
        springs_against_turning_half_as_stiff: {
            "exact-beam-against-turning",
            "segments-against-turning",
            "elements-against-turning",
        },
        a_pin_taken_for_a_free_end: {"matched-against-turning", "best-dashpot-against-turning"},
        modes_that_swing_together: {"lumped-at-a-quarter", "lumped-at-mid-span", "lumped-of-other-modes"},
        curvature_forgotten_in_one_wave: {"lumped-of-other-modes"},
    },
}
"""By scene: each fault with gates that it turns red."""
