"""Faults that rows of sliders, friction, links that stretch and of what stands between all supports have to find."""

from functools import cache

from msgspec.structs import replace

from verify.chain import dynamics, problems, splitting, stretching
from verify.contact import foot, layer
from verify.exact import error_laws, sweeps
from verify.exact import modes as exact_modes
from verify.judge import sizing
from verify.models.catalogue import MODELS
from verify.motion import carried, friction_kernels, kernels
from verify.motion.stepping import Sliding
from verify.segments import linear as segment_linear
from verify.stress.motion import sliders


def _anew(patch):
    """Runs that rows share are run again."""
    patch.setattr(sliders, "_legs", cache(sliders._legs.__wrapped__))
    patch.setattr(sliders, "_ridden", cache(sliders._ridden.__wrapped__))


def sliders_a_little_rough(patch):
    _anew(patch)
    true = carried.law_of

    def rough(slider, beam):
        law = true(slider, beam)
        return law._replace(kinetic=1.001 * law.kinetic, static=law.static and 1.001 * law.static, half=0.99 * law.half)

    patch.setattr(carried, "law_of", rough)


def sliders_a_little_heavy(patch):
    _anew(patch)
    true = carried.law_of
    patch.setattr(carried, "law_of", lambda *given: (law := true(*given))._replace(load=1.001 * law.load))


def books_a_little_high(patch):
    _anew(patch)
    true = carried._ledger

    def high(basis, sliding, *given):
        sliding.ledger[:] *= 1.0 + 1e-4
        return true(basis, sliding, *given)

    patch.setattr(carried, "_ledger", high)


def events_a_little_late(patch):
    _anew(patch)
    true = Sliding.events.fget
    patch.setattr(Sliding, "events", property(lambda sliding: true(sliding) * (1.001, 1.0, 1.0)))


def sticks_a_little_less(patch):
    _anew(patch)
    true = carried.law_of

    def weak(slider, beam):
        law = true(slider, beam)
        return law if law.static == law.kinetic else law._replace(static=law.static and 0.999 * law.static)

    patch.setattr(carried, "law_of", weak)


def _on_belts(times, stiffness):
    def planted(patch):
        true = friction_kernels.slide_on_belt

        def off(n_steps, dt, law, belt, spring, *given):
            return true(n_steps, times * dt, law, belt, stiffness * spring, *given)

        patch.setattr(friction_kernels, "slide_on_belt", off)

    return planted


steps_a_little_long, springs_a_little_stiff = _on_belts(1.0 + 1e-6, 1.0), _on_belts(1.0, 1.0001)
steps_a_little_long.__name__, springs_a_little_stiff.__name__ = "steps_a_little_long", "springs_a_little_stiff"


def surfaces_a_little_fast(patch):
    true = kernels.slide_given

    def fast(n_steps, dt, given, *rest):
        return true(n_steps, dt, given._replace(along=1.0001 * given.along), *rest)

    patch.setattr(kernels, "slide_given", fast)


def rods_without_dashpots(patch):
    true = stretching._flattened

    def undamped(*given):
        elastic = true(*given)
        elastic.links[:, 4] = 0.0
        return elastic

    patch.setattr(stretching, "_flattened", undamped)


def links_a_little_quick(patch):
    true = dynamics.accelerations
    patch.setattr(dynamics, "accelerations", lambda *given: (1.0 + 1e-11) * true(*given))


def shapes_a_little_high(patch):
    true = exact_modes.mode_shape
    patch.setattr(exact_modes, "mode_shape", lambda *given: (1.0 + 1e-10) * true(*given))


def loads_of_what_turns(patch):
    model = type(MODELS["analytic"])
    true = model.buckling_load
    patch.setattr(model, "buckling_load", lambda *given: true(*given) or 1e-3)


def sweeps_a_little_late(patch):
    true = sweeps.sweep_harmonic
    patch.setattr(sweeps, "sweep_harmonic", lambda beam, forces, hertz: true(beam, forces, 1.0000001 * hertz))


def joints_that_slip_more(patch):
    true = segment_linear.solve_modes

    def soft(beam, *given, **more):
        return true(replace(beam, shear_stiffness=0.999 * beam.shear_stiffness), *given, **more)

    patch.setattr(segment_linear, "solve_modes", soft)


def sticking_overlooked(patch):
    patch.setattr(layer, "_sticks_at", lambda *given: 4.0)


def feet_that_do_not_stand(patch):
    patch.setattr(foot, "height_swing", lambda span: 2.0)


def others_left_behind(patch):
    true = splitting.linear_states
    patch.setattr(splitting, "linear_states", lambda *given: 0.5 * true(*given))


def sizes_of_the_first_mode(patch):
    true = sizing._reached
    patch.setattr(sizing, "_reached", lambda bench, model, modes, *given: true(bench, model, modes[:1], *given))


def waves_a_little_long(patch):
    true = error_laws.discrete_wavenumber
    patch.setattr(error_laws, "discrete_wavenumber", lambda *given: (1.0 - 1e-9) * true(*given))


def drifts_over_half_the_time(patch):
    true = problems.energy_drift
    patch.setattr(
        problems, "energy_drift", lambda beam, n, height, periods, *given: true(beam, n, height, 0.5 * periods, *given)
    )


FAULTS = {
    "stress": {
        sliders_a_little_rough: {"sliders-written-out", "sliders-not-felt"},
        sliders_a_little_heavy: {"reactions-written-out"},
        books_a_little_high: {"books-written-out"},
        events_a_little_late: {"changes-written-out"},
        sticks_a_little_less: {"changes-written-out"},
        steps_a_little_long: {"friction-branch-by-branch", "friction-at-its-edge"},
        springs_a_little_stiff: {"springs-on-belts", "springs-on-rough-belts"},
        surfaces_a_little_fast: {"surfaces-given", "surfaces-that-carry", "surfaces-that-grip"},
        rods_without_dashpots: {"stretching-written-out"},
        links_a_little_quick: {"joints-at-any-angle"},
        shapes_a_little_high: {"shapes-of-all-supports"},
        loads_of_what_turns: {"buckling-of-all-supports"},
        sweeps_a_little_late: {"slow-and-fast-in-a-sweep"},
        joints_that_slip_more: {"links-that-slip"},
        sticking_overlooked: {"layers-followed"},
        feet_that_do_not_stand: {"feet-summed-up"},
        sizes_of_the_first_mode: {"sizes-of-several-modes"},
        waves_a_little_long: {"waves-on-coarse-parts"},
        drifts_over_half_the_time: {"energy-that-rk4-loses"},
        others_left_behind: {"low-modes-kicked"},
    }
}
