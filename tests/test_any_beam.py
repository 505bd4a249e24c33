"""What holds for every beam with anything on it, by whichever model: the same modes, masses, symmetry, reciprocity."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from verify import analytic_modes as exact
from verify.attached import PointMass, PointSpring
from verify.beam import Beam
from verify.elements import linear as elements
from verify.errors import InputError
from verify.exact.buckling import buckling_load
from verify.options import SUPPORTS
from verify.section import Section
from verify.segments import linear as segments
from verify.segments.assembly import build_chain

L, EI, RHO_A, GA, RHO_I = 0.73, 3.7, 0.31, 3.1e4, 2.3e-5
THEORIES = ("euler-bernoulli", "rayleigh", "timoshenko")
HELD = {"pinned": (True, False), "clamped": (True, True), "guided": (False, True), "free": (False, False)}
CHAIN = {"joints": "tensioned"}


@st.composite
def beams(draw, theories=THEORIES, stepped=True):
    """(beam, theory): ends, up to two steps, bodies and springs of the beam's own size, axial force and ground."""
    theory = draw(st.sampled_from(theories))
    ends = draw(st.tuples(st.sampled_from(SUPPORTS), st.sampled_from(SUPPORTS)))

    def place(kind):
        held = [HELD[end][kind] for end in ends]
        inside = st.floats(0.07, 0.93).map(lambda x: x * L)
        return draw(st.one_of(inside, *[st.just(x) for x, h in zip((0.0, L), held, strict=True) if not h]))

    size = st.floats(0.05, 3.0)
    masses = tuple(
        PointMass(position=place(0), mass=draw(size) * RHO_A * L) for _ in range(draw(st.integers(0, 2)))
    ) + tuple(
        PointMass(position=place(1), rotary_inertia=draw(size) * 1e-2 * RHO_A * L**3)
        for _ in range(draw(st.integers(0, 1)))
    )
    springs = tuple(
        PointSpring(position=place(0), stiffness=10 * draw(size) * EI / L**3) for _ in range(draw(st.integers(0, 2)))
    ) + tuple(PointSpring(position=place(1), rotational=draw(size) * EI / L) for _ in range(draw(st.integers(0, 1))))
    lengths = draw(st.lists(st.floats(0.3, 1.0), min_size=2, max_size=3)) if stepped and draw(st.booleans()) else []
    sections = tuple(
        Section(
            length=n / sum(lengths) * L,
            bending_stiffness=EI * draw(st.floats(0.5, 2.0)),
            mass_per_length=RHO_A * draw(st.floats(0.5, 2.0)),
        )
        for n in lengths
    )
    beam = Beam(
        length=L,
        bending_stiffness=EI,
        mass_per_length=RHO_A,
        shear_stiffness=GA,
        rotary_inertia=RHO_I,
        supports=ends,
        mass=masses,
        spring=springs,
        section=sections,
        foundation=draw(st.sampled_from([0.0, 300.0])),
    )
    if theory != "euler-bernoulli":
        return beam, theory
    pull = draw(st.sampled_from([0.0, 41.0, -0.6]))
    try:
        return replace(beam, tension=pull if pull >= 0 else pull * buckling_load(beam)), theory
    except InputError:  # nothing resists compression: it has no buckling load
        return beam, theory


def solvers(beam, theory):
    chain = {"theory": theory} | (CHAIN if theory != "euler-bernoulli" or beam.tension else {})
    return {
        "exact": lambda n: exact.solve_modes(beam, n, theory=theory),
        "elements": lambda n: elements.solve_modes(beam, n, 30, theory=theory),
        "segments": lambda n: segments.solve_modes(beam, n, 60, **chain),
    }


@settings(max_examples=25, deadline=None)
@given(beams())
def test_the_three_models_have_the_same_first_modes(made):
    """Elements within (beta l)^4/720 of the exact beam, or so; links within theirs of order 2, where beams have steps."""
    found = {name: solve(4).frequencies_hz for name, solve in solvers(*made).items()}
    assert found["elements"] == pytest.approx(found["exact"], rel=2e-4)
    assert found["segments"] == pytest.approx(found["exact"], rel=8e-3 if turns_among_like_links(made[0]) else 5e-2)
    assert (found["exact"] > 0).all()


def turns_among_like_links(beam):
    """Whether no body's rotary inertia and no rotational spring has links of unlike lengths or stiffness near its own.

    Within four of unlike lengths its weights are not mended, of unlike stiffness they are of another beam; its error is
    of order 2: 3 % of mode 4 with 60 links in the worst case seen, 1e-5 with 120, which end elsewhere.
    """
    lengths = build_chain(beam, 60).lengths
    ends = np.cumsum(lengths) * L / lengths.sum()
    turning = [m.position for m in beam.mass if m.rotary_inertia] + [s.position for s in beam.spring if s.rotational]
    around = [lengths[max(i - 5, 0) : i + 6] for i in np.searchsorted(ends, turning)]
    ends_of_pieces = np.cumsum([piece.length for piece in beam.pieces])[:-1]
    steps = ends_of_pieces[np.diff([piece.bending_stiffness for piece in beam.pieces]) != 0.0]
    apart = all(abs(steps - place).min(initial=L) > 5.0 * L / 60.0 for place in turning)
    return apart and all(np.ptp(near) < 0.05 * near[0] for near in around)


def modal_masses(beam, theory, modes, n):
    """Integral of rho A phi^2 by Gauss's rule between all places where anything changes, bodies and turning added."""
    ends = np.cumsum([0.0, *(piece.length for piece in beam.pieces)])
    stops = np.unique(
        [*np.linspace(0, L, 121), *ends, *(m.position for m in beam.mass), *(s.position for s in beam.spring)]
    )
    stops = stops[np.append(True, np.diff(stops) > 1e-9 * L)]
    points, weights = np.polynomial.legendre.leggauss(4)
    half = 0.5 * np.diff(stops)
    x = (stops[:-1, None] + half[:, None] * (points + 1)).ravel()
    density = np.array([beam.pieces[i].mass_per_length for i in np.searchsorted(ends[1:-1], x)])
    total = modes.deflection(x) ** 2 * density @ np.outer(half, weights).ravel()
    if theory == "rayleigh":
        total += RHO_I * (modes.slope(x) ** 2 @ np.outer(half, weights).ravel())
    for body in beam.mass:
        total += body.mass * modes.deflection([body.position])[:, 0] ** 2
        total += body.rotary_inertia * modes.slope([body.position])[:, 0] ** 2
    return total[:n]


@settings(max_examples=15, deadline=None)
@given(beams(theories=("euler-bernoulli", "rayleigh")))
def test_modes_have_modal_mass_one_with_all_that_has_mass(made):
    beam, theory = made
    solve = solvers(beam, theory)
    assert modal_masses(beam, theory, solve["exact"](3), 3) == pytest.approx(np.ones(3), abs=1e-8)
    assert modal_masses(beam, theory, solve["elements"](3), 3) == pytest.approx(np.ones(3), abs=1e-6)
