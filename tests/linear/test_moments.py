"""Point moments: reciprocity with forces, dense elements, orders of elements and chains, motion in time."""

import numpy as np
import pytest
from msgspec.structs import replace

from tests.beams import BAR, BEAMS, HELD, LADEN, close, over
from tests.reference.dense import Elements, phasor
from verify import ExactModel, Excitation, HermiteModel, Keep, PointForce, PointMoment, SegmentModel, simulate
from verify.chain.system import build_system
from verify.errors import InputError

HERTZ = 733.0
X = np.array([0.03, 0.1, 0.17, 0.33, 0.41, 0.52, 0.64])
MOMENT = PointMoment(position=0.231, amplitude=1.3, phase_deg=17.0)
SHEARED = replace(BAR, supports=("clamped", "free"), loss_factor=0.01, foundation=4e6)
THEORIES = [*((BEAMS[name], "euler-bernoulli") for name in BEAMS), (SHEARED, "rayleigh"), (SHEARED, "timoshenko")]


@pytest.mark.parametrize("number", range(len(THEORIES)))
def test_the_deflection_by_a_moment_is_the_rotation_by_a_force(number):
    (beam, theory), at = THEORIES[number], 0.231
    model, places = ExactModel(beam, theory=theory), X[beam.length > X]
    field = model.harmonic(replace(MOMENT, position=at), HERTZ)
    turned = [model.harmonic(PointForce(position=x), HERTZ).rotation(at)[0] for x in places.tolist()]
    close(field.deflection(places), phasor(MOMENT) * np.array(turned))
    unit = replace(MOMENT, amplitude=1.0, phase_deg=0.0)
    assert field.displacement(unit) == pytest.approx(field.rotation(at)[0], rel=1e-12)


@over([*LADEN, "free-free", "pinned-guided"])
def test_elements_under_a_moment_are_those_of_the_textbook(name):
    beam = BEAMS[name]
    model = HermiteModel(beam, 14).cut_at([MOMENT.position])
    written = Elements(beam, model.modes(1).nodes)
    values = written.harmonic(phasor(MOMENT) * written.row(MOMENT.position, 1), HERTZ)
    field = HermiteModel(beam, 14).harmonic(MOMENT, HERTZ)
    close(field.deflection(X), written.values_at(values, X, 0))
    assert field.displacement(MOMENT) == pytest.approx(written.row(MOMENT.position, 1) @ values, rel=1e-7)
    assert field.beam == beam
    assert field.couples == (MOMENT.position,)


@pytest.mark.parametrize(("model", "counts"), [(SegmentModel, (61, 122, 244, 488)), (HermiteModel, (15, 30, 60, 120))])
@pytest.mark.parametrize(
    ("ends", "position"),
    [("clamped-free", 0.231), ("clamped-free", 0.73), ("pinned-pinned", 0.0), ("free-guided", 0.239), ("losses", 0.61)],
)
def test_the_field_and_the_rotation_at_a_moment_are_of_order_four(model, counts, ends, position):
    """Between joints, at a pinned and at a free end."""
    moment = replace(MOMENT, position=position)
    exact = ExactModel(BEAMS[ends]).harmonic(moment, HERTZ)
    fields = [model(BEAMS[ends], n).harmonic(moment, HERTZ) for n in counts]
    errors = np.array([abs(field.deflection(X) - exact.deflection(X)).max() for field in fields])
    own = np.array([abs(field.displacement(moment) - exact.displacement(moment)) for field in fields])
    assert np.log2(errors[0] / errors[-1]) / 3.0 == pytest.approx(4.0, abs=0.6)
    assert np.log2(own[0] / own[-1]) / 3.0 == pytest.approx(4.0, abs=0.8)
    assert errors[-1] < 1e-4 * abs(exact.deflection(X)).max()


def test_a_chain_reads_its_deflection_next_to_a_moment_with_order_two():
    """The spline through its joints has no jump of curvature: the error is the moment times l^2."""
    exact = ExactModel(HELD).harmonic(MOMENT, HERTZ).deflection(MOMENT.position)[0]
    counts = (50, 100, 200, 400, 800)
    off = [abs(SegmentModel(HELD, n).harmonic(MOMENT, HERTZ).deflection(MOMENT.position)[0] - exact) for n in counts]
    assert np.log2(off[0] / off[-1]) / 4.0 == pytest.approx(2.0, abs=0.5)


# --- Time ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("model", "count"), [("analytic", None), ("fem", 14), ("segment", 23)])
def test_a_beam_from_rest_reaches_its_steady_state_under_a_moment(model, count):
    loads = (MOMENT, PointForce(position=0.52, amplitude=2.1, phase_deg=-40.0))
    own = {"model": model, "count": count, "modal_damping": 0.11, "keep": Keep(at=X, samples=2)}
    run = simulate(HELD, Excitation(loads, HERTZ, soft_start_periods=7), 1200 / HERTZ, **own)
    # the steady exact beam has a loss factor: its modes are compared with those of many elements
    model = {None: HermiteModel(HELD, 90), 14: HermiteModel(HELD, 14), 23: SegmentModel(HELD, 23)}[count]
    steady = model.harmonic(loads, HERTZ, modal_damping=0.11).deflection(X).real
    close(run.deflection[-1], steady, 1e-8 if count else 3e-5)


def test_a_moment_that_has_no_effect_or_no_model_is_refused():
    with pytest.raises(InputError, match="is on a clamped support, where nothing turns"):
        ExactModel(HELD).harmonic(replace(MOMENT, position=0.0), HERTZ)
    for model in (ExactModel(HELD), HermiteModel(HELD, 14)):
        with pytest.raises(InputError, match="give a PointForce"):
            model.imposed(MOMENT, HERTZ)
    with pytest.raises(InputError, match="a nonlinear chain takes PointForce alone"):
        build_system(replace(HELD, supports=("pinned", "free")), 9, (MOMENT,), HERTZ)
