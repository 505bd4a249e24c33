"""Sweeps are loops over the single verbs, to rounding, with the same refusals and in a fraction of the time."""

from time import perf_counter

import numpy as np
import pytest
from msgspec.structs import replace

from verify import (
    Beam,
    InputError,
    PointForce,
    PointMass,
    PointSpring,
    Section,
    analytic_modes,
    fem_beam,
    segment_model,
)
from verify.errors import ResonanceError
from verify.models import driven_pencil
from verify.models.fields import phasor
from verify.models.inverse import first_bending

BEAM = Beam(length=0.47, width=0.017, thickness=0.0012, youngs_modulus=71e9, density=2710.0)
FORCES = (
    PointForce(position=0.0613, amplitude=1.3, phase_deg=17.0),
    PointForce(position=0.4019, amplitude=0.4, phase_deg=-71.0),
)
X = np.array([[0.0, 0.013, 0.17], [0.2611, 0.401, 0.47]])
WIDE = np.geomspace(3.0, 5200.0, 23)
SIZED = {"segment": (segment_model, (41,)), "fem": (fem_beam, (41,)), "analytic": (analytic_modes, ())}
LOSSY = replace(BEAM, loss_factor=0.02, supports=("clamped", "guided"))
LOADED = replace(
    LOSSY, mass=(PointMass(position=0.11, mass=0.004),), spring=(PointSpring(position=0.3, stiffness=900.0),)
)
STEPPED = replace(BEAM, section=(Section(length=0.2), Section(length=0.27, thickness=0.0017)))


def off_resonance(model, beam, settings=None):
    """Frequencies a hundredth or more off every resonance: nearer, all digits that a solve loses are lost by both."""
    module, size = SIZED[model]
    resonances = module.solve_modes(beam, 30, *size, **(settings or {})).frequencies_hz
    return np.array([f for f in WIDE if abs(f / resonances - 1.0).min() > 0.01])


def compared(model, beam, frequencies, **settings):
    """(read from a sweep, read from single fields) of deflection, slope and curvature, each (n, ...)."""
    module, size = SIZED[model]
    sweep = module.sweep_harmonic(beam, FORCES, frequencies, *size, **settings)
    singles = [module.solve_harmonic(beam, FORCES, float(f), *size, **settings) for f in frequencies]
    yield sweep.deflection(X), np.array([one.deflection(X) for one in singles])
    yield sweep.slope(X), np.array([one.slope(X) for one in singles])
    yield sweep.shapes(X.ravel(), 2), np.array([one.shapes(X.ravel(), 2) for one in singles])
    yield sweep.field(-1).deflection(X)[None], singles[-1].deflection(X)[None]


@pytest.mark.parametrize("model", SIZED)
@pytest.mark.parametrize(
    "beam",
    [BEAM, LOSSY, replace(BEAM, supports=("free", "pinned")), STEPPED, replace(LOADED, tension=11.0)],
    ids=["pinned", "lossy", "free", "stepped", "loaded"],
)
def test_a_sweep_is_its_single_fields(model, beam):
    frequencies = off_resonance(model, beam)
    assert len(frequencies) > 12
    for derivative, (swept, single) in enumerate(compared(model, beam, frequencies)):
        assert swept.shape == single.shape
        sizes = abs(single).reshape(len(single), -1).max(axis=1)
        if derivative == 0:
            moved = sizes
        elif derivative < 3:  # of a beam that hardly bends, what reading between nodes leaves of rounding
            sizes = sizes + 0.01 * moved * (41.0 / BEAM.length) ** derivative
        errors = abs(swept - single).reshape(len(single), -1).max(axis=1) / sizes
        assert errors.max() < 1e-12, frequencies[errors.argmax()]


@pytest.mark.parametrize(
    ("model", "settings"),
    [
        ("segment", {"joint_dashpot": 2e-4}),
        ("segment", {"modal_damping": 0.013}),
        ("segment", {"reading": "links"}),
        ("segment", {"reading": "raw", "load": "lever", "wall": "half", "grading": 1.7}),
        ("segment", {"theory": "timoshenko"}),
        ("fem", {"modal_damping": 0.013, "grading": 1.7}),
        ("fem", {"theory": "timoshenko"}),
        ("analytic", {"theory": "timoshenko"}),
    ],
)
def test_a_sweep_takes_the_settings_of_a_single_field(model, settings):
    beam = replace(BEAM, supports=("clamped", "pinned"), poissons_ratio=0.3)
    beam = beam if "modal_damping" in settings else replace(beam, loss_factor=0.004)
    for swept, single in compared(model, beam, WIDE[::3], **settings):
        assert swept == pytest.approx(single, rel=0.0, abs=1e-12 * abs(single).max())


@pytest.mark.parametrize("model", ["segment", "fem"])
@pytest.mark.parametrize("graded", [True, False])
def test_a_sweep_of_unlike_parts_and_of_a_heavy_mass_is_its_single_fields(model, graded):
    beam = replace(BEAM, supports=("clamped", "free"), loss_factor=0.013)
    heavy = replace(beam, mass=(PointMass(position=0.47, mass=2e7 * beam.mass_per_length * beam.length),))
    settings = {"grading": 0.001} if graded else {}
    for swept, single in compared(model, beam if graded else heavy, WIDE[::3], **settings):
        assert swept == pytest.approx(single, rel=0.0, abs=1e-12 * abs(single).max())


@pytest.mark.parametrize("model", SIZED)
def test_few_frequencies_are_solved_as_single_fields_are(model):
    for swept, single in compared(model, BEAM, np.array([4011.0, 127.0])):
        assert swept == pytest.approx(single, rel=1e-13)


@pytest.mark.parametrize("model", SIZED)
@pytest.mark.parametrize("n_frequencies", [3, 30])
def test_a_resonance_in_a_sweep_is_refused_by_its_index(model, n_frequencies):
    module, size = SIZED[model]
    resonance = float(module.solve_modes(BEAM, 5, *size).frequencies_hz[4])
    frequencies = np.linspace(71.0, 93.0, n_frequencies)
    frequencies[2] = resonance * (1.0 + 3e-10)
    with pytest.raises(ResonanceError, match=rf"frequencies_hz\[2\] = .*mode 5 of the {model} model"):
        module.sweep_harmonic(BEAM, FORCES, frequencies, *size)
    frequencies[2] = resonance * (1.0 + 3e-8)
    assert np.isfinite(module.sweep_harmonic(BEAM, FORCES, frequencies, *size).deflection(0.1)).all()
    assert len(module.sweep_harmonic(replace(BEAM, loss_factor=1e-3), FORCES, [resonance], *size)) == 1


@pytest.mark.parametrize("model", SIZED)
@pytest.mark.parametrize(
    ("frequencies", "said"),
    [
        ([50.0, 60.0, float("nan")], r"frequencies_hz\[2\] = nan"),
        ([50.0, -60.0, 70.0], r"frequencies_hz\[1\] = -60.0"),
        ([50.0, 60.0, 0.0, 80.0], r"frequencies_hz\[2\] = 0.0"),
        ([float("inf"), 60.0], r"frequencies_hz\[0\] = inf"),
        ([], "frequencies_hz is empty"),
        (["fifty"], "frequencies_hz = "),
        (np.full(10_000_000, 50.0), "more than 5e\\+07: give fewer"),
    ],
)
def test_a_sweep_refuses_what_a_field_refuses_and_says_where(model, frequencies, said):
    module, size = SIZED[model]
    with pytest.raises(InputError, match=said):
        module.sweep_harmonic(BEAM, FORCES, frequencies, *size)


@pytest.mark.parametrize("model", SIZED)
def test_a_sweep_refuses_forces_and_places_that_a_field_refuses(model):
    module, size = SIZED[model]
    with pytest.raises(InputError, match=r"force.position = 0.48 lies off the beam"):
        module.sweep_harmonic(BEAM, PointForce(position=0.48), [50.0, 60.0], *size)
    sweep = module.sweep_harmonic(BEAM, PointForce(position=0.1), 50.0, *size)
    assert sweep.deflection(0.1).shape == sweep.deflection([0.1]).shape == (1, 1)
    with pytest.raises(InputError, match=r"x = 0.5 lies off the beam"):
        sweep.slope(0.5)
    with pytest.raises(InputError, match=r"index = 1: the sweep has 1 "):
        sweep.field(1)


@pytest.mark.parametrize("model", SIZED)
@pytest.mark.parametrize("supports", [("pinned", "pinned"), ("free", "free"), ("clamped", "free")])
def test_frequencies_of_many_beams_are_those_of_each(model, supports):
    module, size = SIZED[model]
    own = replace(BEAM, supports=supports)
    beams = [own, replace(own, length=0.83, thickness=0.002), replace(STEPPED, supports=supports), own]
    beams += [replace(own, mass=(PointMass(position=0.11, mass=0.004),)), replace(own, supports=("pinned", "guided"))]
    found = module.sweep_modes(beams, 6, *size)
    each = np.array([module.solve_modes(beam, 6, *size).frequencies_hz for beam in beams])
    assert found.shape == (6, 6)
    assert found == pytest.approx(each, rel=1e-13)


@pytest.mark.parametrize(("model", "size"), [("segment", (300,)), ("fem", (160,))])
def test_many_beams_of_many_parts_are_taken_one_by_one(model, size):
    module = SIZED[model][0]
    beams = [STEPPED, replace(STEPPED, thickness=0.0013)]
    each = np.array([module.solve_modes(beam, 3, *size).frequencies_hz for beam in beams])
    assert module.sweep_modes(beams, 3, *size) == pytest.approx(each, rel=1e-13)


def test_a_beam_that_is_refused_is_named_by_its_index():
    crushed = replace(BEAM, tension=-1e4)
    for model, (module, size) in SIZED.items():
        with pytest.raises(InputError, match=r"^beams\[1\]: .*tension"):
            module.sweep_modes([BEAM, crushed], 3, *size)
        with pytest.raises(InputError, match="beams is empty"):
            module.sweep_modes([], 3, *size)
        with pytest.raises(
            InputError, match=r"^beams: 3 beams of 20000000 numbers each are more than 5e\+07: give fewer"
        ):
            module.sweep_modes([BEAM] * 3, 20_000_000, *size)
        if model != "analytic":
            with pytest.raises(InputError, match=r"beams\[0\]: n_modes = 300"):
                module.sweep_modes([BEAM], 300, *size)


@pytest.mark.parametrize("model", ["segment", "fem"])
def test_a_sweep_solves_its_modes_once(monkeypatch, model):
    solved = []
    plain = driven_pencil.modal_basis
    monkeypatch.setattr(driven_pencil, "modal_basis", lambda *a, **k: solved.append(1) or plain(*a, **k))
    module, size = SIZED[model]
    beam = replace(BEAM, length=0.4701 if model == "fem" else 0.4702)  # nobody has asked for its modes before
    for frequencies in (WIDE, WIDE + 0.3):
        module.sweep_harmonic(beam, FORCES, frequencies, *size)
    module.unit_responses(beam, [0.1], [50.0, 60.0], X.ravel(), *size)
    assert len(solved) == 1


@pytest.mark.parametrize(("model", "count"), [("segment", 30), ("fem", 30), ("fem", 130)])
def test_beams_of_any_loss_factor_share_their_modes(monkeypatch, model, count):
    """Also above the dense size, where modes are no sharp ones; each keeps its own loss."""
    solved = []
    plain = driven_pencil.modal_basis
    monkeypatch.setattr(driven_pencil, "modal_basis", lambda *a, **k: solved.append(1) or plain(*a, **k))
    module, _ = SIZED[model]
    beams = [replace(BEAM, length=0.4703, supports=("clamped", "pinned"), loss_factor=eta) for eta in (0.0, 0.02, 0.3)]
    for beam in beams:
        alone = module.solve_harmonic(beam, FORCES, 61.3, count)
        units = module.unit_responses(beam, [force.position for force in FORCES], [61.3], X.ravel(), count)[0]
        summed = sum(phasor(force) * unit for force, unit in zip(FORCES, units, strict=True))
        assert summed == pytest.approx(alone.deflection(X.ravel()), rel=1e-9)
        assert alone.beam is beam
    module.solve_harmonic(beams[1], FORCES, 61.3, count, modal_damping=0.01)
    assert len(solved) == 1


def least_seconds(job, rounds=3):
    """The least of a few."""
    found = []
    for _ in range(rounds):
        start = perf_counter()
        job()
        found.append(perf_counter() - start)
    return min(found)


@pytest.mark.parametrize("beam", [BEAM, LOSSY], ids=["undamped", "lossy"])
@pytest.mark.parametrize("model", ["segment", "fem"])
def test_a_sweep_takes_a_tenth_of_a_loops_time_at_most(model, beam):
    """A hundred fields of 49 parts, read at as many places: 19 to 52 times faster when measured."""
    module, places = SIZED[model][0], np.linspace(0.0, beam.length, 100)
    frequencies = np.linspace(4000.3, 4600.7, 100)
    sweep = least_seconds(lambda: module.sweep_harmonic(beam, FORCES, frequencies, 49).deflection(places), rounds=7)
    loop = least_seconds(
        lambda: [module.solve_harmonic(beam, FORCES, float(f), 49).deflection(places) for f in frequencies], rounds=2
    )
    assert loop > 10.0 * sweep, loop / sweep


@pytest.mark.parametrize("name", SIZED)
def test_beams_may_be_any_that_can_be_gone_through_a_generator_too(name):
    module, size = SIZED[name]
    beams = [replace(BEAM, length=0.3 + 0.1 * i) for i in range(3)]
    assert np.array_equal(module.sweep_modes(iter(beams), 4, *size), module.sweep_modes(beams, 4, *size))
    with pytest.raises(InputError, match="beams has 3: give a Beam"):
        module.sweep_modes((one for one in (BEAM, 3)), 4, *size)


@pytest.mark.parametrize("pull", [0.0, 3.7, -2.0])
def test_about_where_bending_begins_is_where_a_uniform_beam_between_pins_does(pull):
    """(pi/L)^4 EI/m and, under a pull, (pi/L)^2 T/m more; of a push nothing is taken off."""
    lengths, stiffness, mass = np.array([0.2, 0.3, 0.11]), 5.3, 0.41
    whole, given = lengths.sum(), (np.full(3, stiffness), np.full(3, mass))
    expected = (np.pi / whole) ** 4 * stiffness / mass + (np.pi / whole) ** 2 * max(pull, 0.0) / mass
    assert first_bending(lengths, *given, pull) == pytest.approx(expected, rel=1e-13)
