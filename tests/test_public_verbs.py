"""Every public verb takes numpy's numbers for Python's, and refuses what is of another kind in one sentence."""

import numpy as np
import pytest

from verify import (
    Beam,
    Contact,
    Foot,
    InputError,
    PointForce,
    PointMass,
    Slider,
    analytic_modes,
    bend,
    fem_beam,
    free_vibration,
    run_motors,
    segment_model,
    simulate,
)

BEAM = Beam(length=0.31, width=0.013, thickness=0.0021, youngs_modulus=101e9, density=8400.0)
FORCE = PointForce(position=0.05, amplitude=1.7)
MODELS = ((segment_model, (9,)), (fem_beam, (9,)), (analytic_modes, ()))
VERBS = {
    f"{model.__name__.rpartition('.')[2]}.{name}": (getattr(model, name), (*asked, *size))
    for model, size in MODELS
    for name, asked in (
        ("solve_modes", (BEAM, 3)),
        ("sweep_modes", ([BEAM], 3)),
        ("solve_harmonic", (BEAM, FORCE, 433.0)),
        ("sweep_harmonic", (BEAM, FORCE, [433.0])),
        ("unit_responses", (BEAM, 0.1, 433.0, 0.2)),
        ("n_elastic", (BEAM,)),
        ("unknowns", (BEAM,)),
    )
    if hasattr(model, name)
} | {
    "frequency_hz": (analytic_modes.frequency_hz, (BEAM, 3)),
    "exact_frequency_hz": (analytic_modes.exact_frequency_hz, (BEAM, 3)),
    "mode_shape": (analytic_modes.mode_shape, (BEAM, 3, 0.1)),
    "mode_shapes": (analytic_modes.mode_shapes, (BEAM, 3, 0.1)),
    "modes_below": (analytic_modes.modes_below, (BEAM, 20.0)),
}
ON_A_BEAM = {
    **{name: verb for name, verb in VERBS.items() if not name.endswith("sweep_modes")},
    "buckling_load": (analytic_modes.buckling_load, (BEAM,)),
}
UNSIZED = [analytic_modes.frequency_hz, analytic_modes.exact_frequency_hz, analytic_modes.stepped_frequency_hz]


@pytest.mark.parametrize("theory", [None, 3, ["rayleigh"], np.array(["rayleigh", "timoshenko"]), "raleigh"])
@pytest.mark.parametrize("verb", VERBS)
def test_a_theory_is_one_of_the_words(verb, theory):
    called, given = VERBS[verb]
    with pytest.raises(InputError, match=r"^theory = .* is not known: (known are euler|did you mean 'rayleigh'\?)"):
        called(*given, theory=theory)


@pytest.mark.parametrize("verb", ON_A_BEAM)
def test_a_verb_on_a_beam_is_of_a_beam(verb):
    called, given = ON_A_BEAM[verb]
    with pytest.raises(InputError, match=r"beam = \[0.31\]: give a Beam"):
        called([0.31], *given[1:])


@pytest.mark.parametrize("word", [None, 7, np.array(["half", "gregory"])])
@pytest.mark.parametrize("field", ["wall", "joints", "attachment", "load", "reading", "line"])
def test_a_setting_of_segments_is_one_of_its_words(field, word):
    """`load` of modes in time was dropped, whatever it was."""
    in_time = field in ("line", "load")
    calls = [lambda **named: segment_model.time_basis(BEAM, 9, **named)] * in_time
    if field != "line":
        calls.append(lambda **named: segment_model.solve_harmonic(BEAM, FORCE, 433.0, 9, **named))
    if field in ("wall", "joints", "attachment"):
        calls.append(lambda **named: segment_model.sweep_modes([BEAM] * 9, 3, 9, **named))
    for call in calls:
        with pytest.raises(InputError, match=f"{field} = .* is not known: known are "):
            call(**{field: word})


@pytest.mark.parametrize("verb", UNSIZED)
@pytest.mark.parametrize("mode", [True, np.array(3.5), np.array([3]), "3", None])
def test_a_mode_is_a_whole_number(verb, mode):
    with pytest.raises(InputError, match=r"mode = .*: modes are numbered from 1"):
        verb(BEAM, mode)


@pytest.mark.parametrize("n", [0, -1, True, 2.5, None, [3]])
def test_shapes_are_of_a_whole_number_of_modes(n):
    with pytest.raises(InputError, match=r"n_modes = .*: give a whole number of at least 1"):
        analytic_modes.mode_shapes(BEAM, n, 0.1)


def test_a_count_that_no_machine_counts_to_is_refused():
    for model, size in MODELS[:2]:
        with pytest.raises(InputError, match=r"n_(segments|elements) = .*: give a whole number of at most 1e\+100"):
            model.solve_modes(BEAM, 3, 10**300)
        with pytest.raises(InputError, match=r"n_(segments|elements) = -2: give a whole number of at least"):
            model.n_elastic(BEAM, -2)
        assert np.array_equal(
            model.unit_responses(BEAM, 0.1, 433.0, 0.2, np.int8(*size)), model.unit_responses(BEAM, 0.1, 433.0, 0.2, 9)
        )
    with pytest.raises(InputError, match=r"n_modes = 1000000000000 would take about"):
        analytic_modes.mode_shapes(BEAM, 10**12, 0.1)


@pytest.mark.parametrize("index", [2, -3, True, 1.0, None, [0]])
def test_a_sweep_has_fields_by_whole_numbers(index):
    sweep = analytic_modes.sweep_harmonic(BEAM, FORCE, [433.0, 99.0])
    assert sweep.field(np.int64(-1)).frequency_hz == 99.0
    with pytest.raises(InputError, match=r"index = .*: the sweep has 2 frequencies, counted from 0"):
        sweep.field(index)


SLIDERS = [
    Slider(mass=2e-3, mu=0.2, contact=Contact(stiffness=2e5), coupling="one-way", position=x) for x in (0.11, 0.2)
]


def test_what_stands_on_a_beam_may_come_in_an_array():
    masses = [PointMass(position=0.1, mass=0.02), PointMass(position=0.2, mass=0.01)]
    assert Beam(**SIZES, mass=np.array(masses, dtype=object)).mass == tuple(masses)
    assert Beam(**SIZES, mass=np.array([])).mass == ()
    with pytest.raises(InputError, match=r"beam.spring has .*: give a PointSpring, or a list of them"):
        Beam(**SIZES, spring=np.array(3.0))
    with pytest.raises(InputError, match=r"beam.shape = .* is not known"):
        Beam(**SIZES, shape=np.ones((2, 2)))


SIZES = {"length": 0.31, "width": 0.013, "thickness": 0.0021, "youngs_modulus": 101e9, "density": 8400.0}


def test_speeds_that_several_sliders_are_held_at_may_come_in_an_array():
    def speeds(held):
        runs = run_motors(BEAM, FORCE, 2211.0, 1e-3, sliders=SLIDERS, count=9, samples=2, held_speed=held)
        return [run.speed[-1] for run in runs]

    assert speeds(np.array([0.125, -0.25])) == speeds([0.125, -0.25]) == [0.125, -0.25]
    with pytest.raises(InputError, match="held_speed has 3 of them for 2 sliders"):
        speeds(np.ones(3))


@pytest.mark.parametrize("given", ["no", 1, None, 0.0])
def test_a_flag_is_true_or_false(given):
    """Any word was true."""
    for field in ("pitches", "mirrored"):
        with pytest.raises(InputError, match=f"slider.foot.{field} = .*: give a bool"):
            Foot(length=0.01, points=3, **{field: given})
    for field in ("ledger", "patient"):
        with pytest.raises(InputError, match=f"{field} = .*: give a bool"):
            simulate(BEAM, FORCE, 433.0, 1e-3, count=9, **{field: given})
    with pytest.raises(InputError, match=r"patient = .*: give a bool"):
        run_motors(BEAM, FORCE, 2211.0, 1e-3, sliders=SLIDERS, count=9, patient=given)


def test_times_and_sizes_of_which_no_figure_can_be_made_are_refused():
    """Such ended in ZeroDivisionError, in NaN and in infinite energies."""
    with pytest.raises(InputError, match=r"duration = 1e-300: give a finite number of at least 1e-100 \(seconds\)"):
        simulate(BEAM, FORCE, 433.0, 1e-300, count=9)
    with pytest.raises(InputError, match="soft_start_periods = 1e-300: give 0, or at least 1e-100"):
        simulate(BEAM, FORCE, 433.0, 1e-3, count=9, soft_start_periods=1e-300)
    with pytest.raises(InputError, match=r"duration = 1e\+308 s is more than 1e\+12 periods of the highest mode"):
        free_vibration(BEAM, 2, 1e308, amplitude=1e-3, count=9)
    with pytest.raises(InputError, match=r"amplitude = 1e\+308: give a finite number .* \(metres\)"):
        free_vibration(BEAM, 2, 1e-3, amplitude=1e308, count=9)


def test_a_bent_chain_takes_numbers_of_numpys():
    rod = Beam(**SIZES, supports=("clamped", "free"))
    assert bend(rod, np.int8(12), np.float32(0.5)).deflection == bend(rod, 12, 0.5).deflection
    with pytest.raises(InputError, match=r"joints = .* is not known: known are series"):
        bend(rod, 12, 0.5, joints=np.array(["series", "printed"]))
