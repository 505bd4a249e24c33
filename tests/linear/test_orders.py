"""Orders that are told as due, beside those that chains have against beams by their states."""

from itertools import pairwise

import numpy as np
import pytest
from msgspec.structs import replace

from tests.reference.transfer import frequency_near
from verify.attached import PointMass, PointSpring
from verify.beam import Beam
from verify.models.catalogue import MODELS
from verify.section import Section
from verify.segments.linear import solve_modes

L = 0.7
BAR = Beam(length=L, width=0.03, thickness=0.02, youngs_modulus=70e9, density=2700.0)
CANTILEVER = replace(BAR, supports=("clamped", "free"))
STEPPED = replace(BAR, section=(Section(length=0.3), Section(length=0.4, thickness=0.03)))
ALIKE = replace(BAR, section=(Section(length=0.3), Section(length=0.4)))
DENSER = replace(BAR, section=(Section(length=0.3, density=8000.0), Section(length=0.4)))
PULLED, GROUNDED = replace(BAR, tension=4e5), replace(BAR, foundation=1e8)
TIMOSHENKO, TENSIONED, LEVER = {"theory": "timoshenko"}, {"joints": "tensioned"}, {"attachment": "lever"}
order_of = MODELS["segment"].order
COUNTS = (70, 140, 280, 560)


def mass(beam, at, **more):
    return replace(beam, mass=(PointMass(position=at, mass=0.3, **more),))


def body(beam, at):
    return mass(beam, at, rotary_inertia=2e-3)


def spring(beam, at, **given):
    return replace(beam, spring=(PointSpring(position=at, **(given or {"stiffness": 3e5})),))


def seen(beam, settings):
    """Orders of mode 2 from size to size, (3,), of the worst of three sizes each."""
    theory = settings.get("theory", "euler-bernoulli")
    exact = frequency_near(beam, theory, solve_modes(beam, 2, 560, **settings).frequencies_hz[-1])

    def worst(count):
        found = [solve_modes(beam, 2, n, **settings).frequencies_hz[-1] for n in range(count, count + 3)]
        return max(abs(f / exact - 1.0) for f in found)

    return [float(np.log2(one / other)) for one, other in pairwise(map(worst, COUNTS))]


@pytest.mark.parametrize(
    ("beam", "settings", "due"),
    [
        pytest.param(GROUNDED, TIMOSHENKO | TENSIONED, 2, id="ground that slips"),
        pytest.param(GROUNDED, {"theory": "rayleigh"} | TENSIONED, 4, id="ground that does not"),
        pytest.param(mass(CANTILEVER, L), TIMOSHENKO | LEVER, 1, id="tip by lever, shear"),
        pytest.param(mass(CANTILEVER, L), LEVER, 4, id="tip by lever"),
        pytest.param(mass(CANTILEVER, L), TIMOSHENKO | TENSIONED, 4, id="tip under shear"),
        pytest.param(spring(BAR, 0.2613, rotational=3e3), TIMOSHENKO | TENSIONED, 4, id="couple under shear"),
        pytest.param(mass(BAR, 0.2613), TIMOSHENKO | TENSIONED, 2, id="mass under shear"),
        pytest.param(mass(STEPPED, 0.3), {"grading": 2.0}, 1, id="mass where graded sections meet"),
        pytest.param(mass(STEPPED, 0.3), {"grading": 2.0} | TIMOSHENKO, 1, id="the same under shear"),
        pytest.param(mass(ALIKE, 0.3), {"grading": 2.0}, 1, id="mass where graded sections alike meet"),
        pytest.param(mass(STEPPED, 0.3), {"grading": 2.0} | LEVER, 2, id="the same by lever"),
        pytest.param(mass(STEPPED, 0.3), {}, 2, id="mass on a step"),
        pytest.param(body(STEPPED, 0.3), {}, 1, id="body on a step"),
        pytest.param(body(ALIKE, 0.3), {}, 2, id="body where sections alike meet"),
        pytest.param(body(DENSER, 0.3), {}, 2, id="body where density changes"),
        pytest.param(STEPPED, {"joints": "printed"}, 2, id="printed, one modulus"),
        pytest.param(mass(PULLED, 0.2613), TENSIONED, 4, id="mass in tension"),
        pytest.param(replace(body(CANTILEVER, L), tension=4e5), TENSIONED, 4, id="tip body in tension"),
    ],
)
def test_the_order_that_is_due_is_the_one_that_a_chain_has(beam, settings, due):
    assert order_of(beam, **settings) == due
    orders = seen(beam, settings)
    assert orders[-1] == pytest.approx(due, abs=0.25)
    assert abs(orders[-1] - due) <= abs(orders[0] - due) + 0.1


def test_what_is_lower_for_another_reason_is_told_where_two_would_meet():
    assert order_of(body(STEPPED, 0.3), theory="timoshenko") == 1
    assert order_of(replace(body(STEPPED, 0.2), tension=4e5), joints="tensioned") == 2
    assert order_of(body(PULLED, 0.2)) == 2
