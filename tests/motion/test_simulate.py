"""How runs begin, end, are interrupted and are refused."""

import signal
from time import perf_counter

import msgspec
import numpy as np
import pytest
from motion_reference import FORCES, FREQUENCY, STRIP

from verify.errors import InputError
from verify.motion import stepping as slider_run
from verify.motion.free_vibration import free_vibration
from verify.motion.records import SLIPS
from verify.motion.simulate import simulate
from verify.slider import Slider, changed

LITERAL = str.maketrans({sign: "\\" + sign for sign in "()[]"})
"""Of what a message is matched by: brackets are what they are."""
LIGHT = Slider(mass=1.3e-3, mu=0.21, slope=120.0, position=0.17, coupling="one-way")


def slid(duration=1.7e-3, slider=LIGHT, **asked):
    return simulate(STRIP, FORCES, FREQUENCY, duration, slider=slider, **{"count": 11, **asked})


def test_a_slider_that_leaves_the_beam_stops_with_the_time_and_keeps_its_history():
    found = slid(
        0.02, msgspec.structs.replace(LIGHT, position=0.4297, speed=0.13), samples=2001, soft_start_periods=0.7
    )
    slowing = 0.21 * 9.81  # 0.13 t - slowing t^2 / 2 = 0.3 mm
    time = (0.13 - np.sqrt(0.13**2 - 2 * slowing * 0.3e-3)) / slowing
    assert found.statistics.stopped == "left the beam"
    assert found.end.time == pytest.approx(time, rel=3e-3)
    assert found.times[-1] <= found.end.time < found.times[-1] + 3e-5
    assert np.all(found.position[:-1] <= STRIP.length)  # the step that crosses the end may be a sample
    assert found.end.position > STRIP.length
    assert len(found.times) == len(found.travelled) == len(found.speed) == len(found.deflection) > 200
    assert np.all(np.diff(found.position) > 0)


@pytest.mark.parametrize(("position", "speed"), [(0.43, 1e-9), (0.43, 3e-17), (0.0, -1e-9), (0.43, 0.2)])
def test_a_slider_at_the_very_end_does_not_hang(position, speed):
    found = slid(2e-4, msgspec.structs.replace(LIGHT, position=position, speed=speed), ledger=False)
    assert found.statistics.stopped in ("left the beam", "end")
    assert found.speed[0] == speed


def test_a_slider_that_leaves_in_the_last_step_of_the_growth_has_left():
    steps = simulate(STRIP, FORCES, FREQUENCY, 2e-3, count=11, slider=LIGHT, soft_start_periods=1.0, samples=2)
    growth = 1 / FREQUENCY
    leaving = msgspec.structs.replace(LIGHT, position=STRIP.length - 0.2 * growth * 0.9995, speed=0.2)
    found = slid(2e-3, leaving, soft_start_periods=1.0, samples=2)
    assert steps.statistics.stopped == "end"
    assert found.statistics.stopped == "left the beam"
    with pytest.raises(InputError, match="off the beam"):
        slid(1e-3, LIGHT, continue_from=found)


@pytest.mark.parametrize("after", [1, 3])
def test_an_interrupt_from_the_progress_returns_what_is_kept(after, monkeypatch):
    monkeypatch.setattr(slider_run, "CHUNK", 40)
    heard = []

    def progress(part):
        heard.append(part)
        if len(heard) == after:
            raise KeyboardInterrupt

    found = slid(3e-3, progress=progress, samples=101)
    whole = slid(3e-3, samples=101)
    assert found.statistics.stopped == "interrupted"
    assert heard == sorted(heard)
    assert found.statistics.steps == 40 * after
    n = len(found.times)
    assert 1 < n < 101
    assert np.array_equal(found.travelled, whole.travelled[:n])
    rest = slid(3e-3 - found.end.time, continue_from=found, samples=101)
    assert rest.travelled[-1] + found.end.position == pytest.approx(whole.end.position, abs=1e-15)
    assert rest.end.q == pytest.approx(whole.end.q, abs=1e-9 * abs(whole.end.q).max())


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs a timer's signal")
def test_a_real_interrupt_inside_the_compiled_loop_finds_the_books_closed(monkeypatch):
    """The signal is answered when the loop comes back, before its caller can write anything down."""
    monkeypatch.setattr(slider_run, "CHUNK", 300_000)
    slid(ledger=False)  # compiled

    def interrupt(*_):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.1)
        found = slid(2000.0, samples=200_001, ledger=False)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert found.statistics.stopped == "interrupted"
    assert found.statistics.steps >= 300_000
    assert found.statistics.steps == pytest.approx(found.end.time / found.statistics.step_s, rel=1e-9)
    assert found.times[-1] <= found.end.time < found.times[-1] + 2000.0 / 200_000 * 1.001
    assert len(found.times) == len(found.travelled) > 300
    # the modes stand where the time says: those of the beam alone, which a slider coupled one-way does not move
    alone = simulate(STRIP, FORCES, FREQUENCY, found.end.time, count=11, samples=2, ledger=False)
    assert not found.coupling.two_way
    assert found.end.q == pytest.approx(alone.end.q, abs=1e-6 * abs(alone.end.q).max())


@pytest.mark.parametrize("coupling", ["one-way", "two-way"])
@pytest.mark.parametrize("law", ["tanh", "coulomb"])
def test_a_run_with_a_slider_continues(law, coupling):
    slider = changed(LIGHT, law=law, coupling=coupling, mass=0.2)
    asked = {"slider": slider, "samples": 11, "step": 1e-6, "ledger": False}
    whole = slid(2e-3, **asked)
    begun = slid(0.8e-3, **asked)
    ended = slid(1.2e-3, continue_from=begun, **asked)
    assert ended.times[0] == pytest.approx(0.8e-3)
    assert ended.travelled[-1] + begun.travelled[-1] == pytest.approx(
        whole.travelled[-1], abs=2e-5 * abs(whole.travelled).max()
    )
    assert ended.speed[-1] == pytest.approx(whole.speed[-1], abs=1e-5 * abs(whole.speed).max())
    assert ended.speed[0] == begun.speed[-1]


def test_a_slider_put_on_a_beam_that_moves_already_starts_where_it_says():
    moving = simulate(STRIP, FORCES, FREQUENCY, 2.3e-3, count=11)
    found = slid(1e-3, continue_from=moving)
    assert found.position[0] == 0.17
    assert found.times[0] == moving.times[-1]


def test_a_slider_at_rest_on_a_beam_at_rest_sticks_from_the_start():
    slider = changed(LIGHT, law="coulomb", mu=0.03)
    found = slid(2e-3, slider, soft_start_periods=1.0, samples=2001, ledger=False)
    assert found.events[0, 1] == SLIPS
    before = (found.times > 0) & (found.times < found.events[0, 0])
    assert before.sum() > 30
    assert np.array_equal(found.speed[before], found.surface_speed[before])


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"duration": np.nan}, "duration = nan"),
        ({"duration": -1.0}, "duration = -1.0"),
        ({"count": None}, "count is missing"),
        ({"count": 2.5}, "count = 2.5"),
        ({"count": 11, "model": "analytic"}, "count = 11 is for models of parts"),
        ({"modes": 5}, "modes = 5 is for model = analytic: segment keeps all it has, leave it out"),
        ({"modes": 5, "model": "fem", "start": "steady"}, "modes = 5 is for model = analytic: fem keeps all it has"),
        ({"model": "segmnt"}, "model = 'segmnt'"),
        ({"start": "soft"}, "start = 'soft'"),
        ({"samples": 1}, "samples = 1"),
        ({"samples": 2.5}, "samples = 2.5"),
        ({"samples": 10**8}, "samples = 100000000"),
        ({"step": np.nan}, "step = nan"),
        ({"step": 1e-320, "slider": LIGHT}, "more than 2e\\+09 steps"),
        ({"at": [0.1, 0.5]}, "lies off the beam"),
        ({"at": [np.nan]}, "lies off the beam"),
        ({"modal_damping": -0.1}, "modal_damping = -0.1"),
        ({"modal_damping": np.nan}, "modal_damping = nan"),
        ({"modal_damping": 1.0}, "modal_damping = 1.0"),
        ({"soft_start_periods": 3.0}, "the forces grow over .* s: lower soft_start_periods, or lengthen the duration"),
        ({"envelope": [(3e-2, [0.0, 1.0])]}, "grow over 0.03 s of duration = .* s: shorten envelope, or lengthen"),
        ({"soft_start_periods": np.nan}, "soft_start_periods = nan"),
        ({"soft_start_periods": 1.0, "start": "steady"}, "soft_start_periods = 1.0 with start = 'steady': a beam that"),
        (
            {"envelope": [(1e-4, [0, 1])], "start": "steady"},
            "envelope = [(0.0001, [0, 1])] with start = 'steady': a beam that moves already has no start, leave it out",
        ),
        (
            {"envelope": [(1e-4, [0, 1])], "soft_start_periods": 2},
            "soft_start_periods = 2 and envelope = [(0.0001, [0, 1])]: give one of the two",
        ),
        ({"envelope": np.array([[1e-4, 1.0]])}, "give pieces (seconds, coefficients)"),
        ({"envelope": [(1e-4, [0.0, np.nan])]}, "envelope: give pieces"),
        ({"envelope": [(-1e-4, [0.0, 1.0])]}, "envelope: give pieces"),
        ({"count": None, "start": "steady"}, "count is missing"),
        ({"slider": msgspec.structs.replace(LIGHT, position=0.4301)}, "slider.position = 0.4301 lies off the beam"),
        (
            {"slider": msgspec.structs.replace(LIGHT, line="raw"), "start": "steady"},
            "slider.line = 'raw' is for a start",
        ),
        ({"slider": msgspec.structs.replace(LIGHT, line="raw"), "model": "fem"}, "which model = fem has none of"),
    ],
    ids=str,
)
def test_bad_input_is_refused_in_one_sentence(asked, message):
    with pytest.raises(InputError, match=message.translate(LITERAL)) as found:
        slid(**asked)
    assert "\n" not in str(found.value)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"mass": 0.0}, "slider.mass = 0.0"),
        ({"mass": np.nan}, "slider.mass = nan"),
        ({"mu": -0.2}, "slider.mu = -0.2"),
        ({"slope": 0.0}, "slider.slope = 0.0"),
        ({"speed": np.inf}, "slider.speed = inf"),
        ({"position": np.nan}, "slider.position = nan"),
        ({"gravity": 0.0}, "presses on nothing"),
        ({"preload": -1.0}, "slider.preload = -1.0"),
        ({"law": "coulomb", "slope": None, "mu_static": 0.1}, "slider.mu_static = 0.1"),
        ({"mu_static": 0.4}, "never sticks"),
        ({"law": "columb"}, "did you mean 'coulomb'"),
        ({"coupling": "twoway"}, "did you mean 'two-way'"),
        ({"line": "row"}, "did you mean 'raw'"),
        ({"kinematics": "follow"}, "did you mean 'following'"),
    ],
)
def test_a_slider_that_cannot_be_is_refused(wrong, message):
    with pytest.raises(InputError, match=message):
        msgspec.structs.replace(LIGHT, **wrong)


def test_what_comes_back_is_frozen():
    found = slid(2e-4)
    for thing, field in (
        (LIGHT, "mass"),
        (found, "times"),
        (found.ledger, "work_in"),
        (found.end, "q"),
        (found.margins, "lift_off"),
    ):
        with pytest.raises(AttributeError):
            setattr(thing, field, 0.0)


def test_notes_say_what_stands_for_what():
    beam = msgspec.structs.replace(STRIP, loss_factor=0.02)

    def notes(**asked):
        return " | ".join(simulate(beam, FORCES, FREQUENCY, 1e-3, **{"count": 11, **asked}).notes)

    assert "a ratio 0.01 of every mode in place of the loss factor 0.02" in notes()
    assert "a ratio 0.03 of every mode in place of the loss factor 0.02" in notes(modal_damping=0.03)
    assert "none, in place of the loss factor 0.02" in notes(modal_damping=0.0)
    assert "the loss factor 0.02 in the steady field" in notes(start="steady")
    assert "forces grow over" in notes(soft_start_periods=1.0)
    assert "closed-form dispersion" in notes()
    assert "first 30 exact modes" in notes(model="analytic", count=None, modes=30)


def test_what_a_run_says_of_its_time_is_no_longer_than_the_clock_saw():
    began = perf_counter()
    slider = Slider(mass=1e-3, mu=0.2, slope=100.0, position=0.19)
    run = simulate(STRIP, FORCES, FREQUENCY, 1e-3, count=6, slider=slider)
    said = run.statistics.set_up_s, run.statistics.wall_s
    assert min(said) > 0.0
    assert sum(said) < perf_counter() - began


@pytest.mark.parametrize("verb", ["simulate", "free_vibration"])
def test_what_is_kept_is_no_array_of_who_asked(verb):
    """Places that were given as an array are those at which was read, whatever is written into it."""
    given = np.array([0.1, 0.2])
    if verb == "simulate":
        found = simulate(STRIP, FORCES, FREQUENCY, 1e-3, count=8, samples=2, at=given)
    else:
        found = free_vibration(STRIP, 2, 1e-3, amplitude=1e-3, count=8, samples=2, at=given)
    given[:] = 0.0
    assert found.points.tolist() == [0.1, 0.2]


def test_a_beam_alone_has_no_way_of_a_slider():
    run = simulate(STRIP, FORCES, 310.0, 0.01, model="fem", count=9, at=0.2)
    for name in ("displacement", "mean_speed"):
        with pytest.raises(InputError, match="displacement and mean_speed are a slider's, and the beam moves alone"):
            getattr(run, name)


def test_a_steady_field_has_no_modes_to_keep():
    with pytest.raises(InputError, match="modes = 5: a beam with start = 'steady' has a field and no modes"):
        simulate(STRIP, FORCES, 310.0, 0.01, model="analytic", modes=5, start="steady", at=0.2)
