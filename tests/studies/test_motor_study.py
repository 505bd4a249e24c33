"""The study of a motor against direct calls, its inputs, its sentences, what it refuses, what it draws."""

import re
from math import pi, sqrt

import numpy as np
import pytest
from msgspec.structs import replace
from packaged import last_of_each

from verify import load_scene, run_scene
from verify.errors import InputError
from verify.motor.figures import at_speed, crest_speed, held, mean_speed, no_load, started, stopped
from verify.motor.run import run_motor
from verify.report.beam_drawing import beam_drawing
from verify.report.plain import run_as_plain
from verify.run.plan import plan_scene
from verify.run.runner import n_steps
from verify.studies.motor import figures as motor_figures
from verify.studies.motor.figures import motor_study
from verify.studies.motor.from_rest import FromRest, RestField, RestHeld, what_stands
from verify.studies.motor.request import case_of
from verify.studies.motor.tables import at_speed_as_plain
from verify.studies.motor.words import doubts, in_short_of
from verify.units import in_words

SMALL = (
    'motor.models=["segment"]',
    "motor.count=49",
    "motor.speeds=3",
    "motor.periods=120",
    "slider.foot.0.points=5",
    "slider.foot.1.points=5",
)
CHAINED = (
    'motor.models=["segment", "chain"]',
    "motor.chain=5e-4",
    "motor.places=2",
    "motor.periods=20",
    "motor.speeds=2",
)


def small(*more):
    return load_scene("preloaded-motor", last_of_each(*SMALL, *more))


def studied(scene):
    return motor_study(scene, scene.motor)


@pytest.fixture(scope="module")
def study():
    return studied(small())


@pytest.fixture(scope="module")
def chained():
    return studied(small(*CHAINED))


def test_held_figures_are_those_of_direct_calls(study):
    scene = small()
    case, (field,) = case_of(scene.motor, scene, "segment"), study.fields
    still, settled = held(case, 0.0)
    assert [one.speed for one in field.curve] == pytest.approx([0.0, -0.5 * crest_speed(case), -crest_speed(case)])
    assert field.stall == still
    assert field.curve[1] == at_speed(case, field.curve[1].speed, settled)
    assert field.curve[1].force == pytest.approx(at_speed(case, field.curve[1].speed).force, rel=0.01)  # settles
    assert field.no_load == no_load(case, None, settled)


def test_free_figures_are_those_of_direct_calls(study):
    scene = small()
    case, (field,) = case_of(scene.motor, scene, "segment"), study.fields
    under_way = started(case, field.no_load.speed, 120)
    run = under_way.run
    assert (field.free.speed, field.free.spread) == mean_speed(run, 30)
    assert field.free.contact_share == pytest.approx(run.contact_share[-30:].mean())
    assert field.free.wear_power == pytest.approx(run.rubbed[-30:].sum() / (run.times[-1] - run.times[-31]))
    assert field.free.damped_power == pytest.approx(run.ledger.damped / run.duration)
    assert field.stop_time == stopped(case, run, 120).time
    assert 0.9 < field.start_time / (0.632 * 0.01 * abs(field.free.speed) / 0.04) < 1.3
    assert 1.8 < field.reversal_time / field.start_time < 2.3


def test_a_free_run_ends_at_the_speed_of_no_load(study):
    (field,) = study.fields
    assert field.free.speed == pytest.approx(field.no_load.speed, rel=0.02)
    assert field.no_load.speed == pytest.approx(-0.0264, rel=0.02)


@pytest.fixture
def unsought(monkeypatch):
    """The speed without load is not sought, where no figure of it is asked for."""
    monkeypatch.setattr(motor_figures, "no_load", lambda case, reach, *more: at_speed(case, -0.026, *more))


INPUTS = {
    "motor.count=98": lambda field: field.stall.force,
    "motor.periods=60": lambda field: field.free.speed,
    "motor.speeds=4": lambda field: field.curve[1].speed,
    "motor.steps_per_period=127": lambda field: field.free.speed,
    'motor.start="rest"': lambda field: field.free.speed,
    "slider.contact.stiffness=9e4": lambda field: field.free.contact_share,
}


@pytest.mark.parametrize("setting", INPUTS)
def test_every_input_moves_a_figure(setting, study, unsought):
    read = INPUTS[setting]
    assert read(studied(small(setting)).fields[0]) != read(study.fields[0])


def test_a_soft_start_and_damping_move_a_start_from_rest(unsought):
    rest = ('motor.start="rest"', "motor.periods=20", "motor.speeds=2")
    plain, soft, damped = (
        studied(small(*rest, *more)).fields[0].free.speed
        for more in ((), ("motor.soft_start_periods=6",), ("motor.modal_damping=0.01",))
    )
    assert len({plain, soft, damped}) == 3


def test_every_input_of_the_runs_from_rest_moves_them(chained, unsought):
    def ends(*more):
        return [one.ends for one in studied(small(*CHAINED, *more)).rest.fields]

    own = [one.ends for one in chained.rest.fields]
    assert [one.title for one in chained.rest.fields] == ["segments", "rigid links", "stretching links"]
    assert ends("motor.chain=4e-4")[0] != own[0]
    assert ends("motor.chain_force=12")[1] != own[1]
    assert [len(one) for one in ends("motor.places=3")] == [6, 6, 6]
    assert ends('motor.links=["stretching"]') == [own[0], own[2]]


def test_a_run_from_rest_is_that_of_a_direct_call(chained):
    scene = small(*CHAINED)
    forces = tuple(replace(one, amplitude=30.0) for one in scene.forces)
    slider = replace(scene.slider, preload=0.2 * 30.0 / 9.0)
    for one in chained.rest.fields:
        model = "segment" if one.model == "segment" else "chain"
        run = run_motor(
            scene.beam,
            forces,
            4276.0,
            5e-4,
            slider=slider,
            model=model,
            count=49,
            start="rest",
            modal_damping=0.0,
            links=one.links,
            samples=4,
            steps_per_period=61,
        )
        assert one.own(False) == pytest.approx(run.travelled[-1], rel=1e-3)


def test_nonlinear_chains_move_a_slider_as_the_linear_one_does_where_forces_are_small(chained, unsought):
    weak = studied(small(*CHAINED, "motor.chain=9e-4", "motor.chain_force=0.05")).rest
    linear, rigid, stretching = (np.array(one.ends) for one in weak.fields)
    largest = abs(linear).max()
    assert rigid == pytest.approx(linear, abs=0.01 * largest)
    assert stretching == pytest.approx(linear, abs=0.01 * largest)
    strong = studied(small(*CHAINED, "motor.chain=9e-4", "motor.chain_force=30")).rest
    linear, rigid, stretching = (np.array(one.ends) for one in strong.fields)
    assert abs(rigid - linear).max() > 0.1 * abs(linear).max()
    assert abs(stretching - linear).max() > 0.1 * abs(linear).max()


def rest_field(model, links, still, turned, ends=(1e-6, -1e-6, 2e-6, -2e-6), error=0.01):
    """A field whose sliders are pushed so much, standing still, the wave either way."""
    there, back = ((RestHeld(speed=v, force=f, error=error, halved=f) for f, v in pair) for pair in (
        ((still, 0.0), (0.1, -0.02)), ((turned, 0.0), (-0.1, 0.02)))
    )  # fmt: skip
    return RestField(
        model=model,
        links=links,
        ends=ends,
        halved=ends,
        curve=tuple(there),
        turned=tuple(back),
        times=(0.0,),
        way=(0.0,),
        whole=True,
    )


def rest_of(*fields):
    return FromRest(force=30.0, preload=0.6, seconds=0.02, size=0.12, places=(0.2, 0.3), fields=fields)


def test_push_turns_round_with_the_wave_and_bias_does_not():
    field = rest_field("chain", "rigid", -0.2, 0.5)
    assert field.push == pytest.approx((0.35, 0.01 / sqrt(2.0)))
    assert field.bias == pytest.approx((0.15, 0.01 / sqrt(2.0)))


def test_which_chain_is_nearer_is_said_where_errors_allow_and_withheld_otherwise():
    beam = rest_field("analytic", "rigid", -0.4, 0.4)
    rigid, near, as_far = (
        rest_field("chain", links, -push, push)
        for links, push in (("rigid", 0.1), ("stretching", 0.3), ("stretching", 0.115))
    )
    assert list(what_stands(rest_of(beam, rigid, near)))[-1].startswith("stretching links push more nearly")
    assert "is withheld" in list(what_stands(rest_of(beam, rigid, as_far)))[-1]


def test_of_pushes_on_either_side_of_the_beams_its_own_error_counts_twice():
    """0.3 below it, 0.35 above: apart by 0.05, with an error of 0.01 each and twice 0.02 of the beam."""
    beam = rest_field("analytic", "rigid", -0.4, 0.4, error=0.02 * sqrt(2.0))
    below, above = rest_field("chain", "rigid", -0.1, 0.1), rest_field("chain", "stretching", -0.75, 0.75)
    assert "is withheld" in list(what_stands(rest_of(beam, below, above)))[-1]
    assert (
        "is withheld" not in list(what_stands(rest_of(beam, below, rest_field("chain", "stretching", -0.15, 0.15))))[-1]
    )


def test_how_fast_a_chain_is_drawn_in_is_told_beside_what_it_pushes():
    beam = rest_field("analytic", "rigid", -0.4, 0.4)
    drawn = replace(rest_field("chain", "rigid", -0.1, 0.1), drawn=2.31)
    assert "over the crests' speed, rigid links 2.3; linear fields have none" in " ".join(
        what_stands(rest_of(beam, drawn))
    )


def test_an_error_of_hundreds_is_written_out():
    beam = rest_field("analytic", "rigid", -0.4, 0.4, ends=(0.0, 0.0, 0.0, 0.0))
    spread = rest_field("chain", "rigid", -0.4, 0.4, ends=(-1e-6, 0.6e-6, -1e-6, 0.6e-6))
    assert " nm)" in next(iter(what_stands(rest_of(beam, spread))))
    assert "e+02" not in next(iter(what_stands(rest_of(beam, spread))))


def test_a_mean_within_twice_its_error_is_not_told():
    beam = rest_field("analytic", "rigid", -0.4, 0.4, ends=(0.0, 0.0, 0.0, 0.0))
    apart = rest_field("chain", "rigid", -0.4, 0.4, ends=(3e-6, 4e-6, 3e-6, 4e-6))
    spread = rest_field("chain", "rigid", -0.4, 0.4, ends=(-9e-6, 10e-6, -9e-6, 10e-6))
    assert "on rigid links +3.5 +- 0.29 µm" in next(iter(what_stands(rest_of(beam, apart))))
    assert "on rigid links no mean that is told from its error" in next(iter(what_stands(rest_of(beam, spread))))


# --- How far it can be believed ---------------------------------------------------------------------------------------


def doubted(study, **changed):
    (field,) = study.fields
    margins = {name: value for name, value in changed.items() if name in ("epsilon", "sag", "step", "chain")}
    free = replace(field.free, contact_share=changed.get("share", field.free.contact_share))
    changed_field = replace(field, free=free, margins=replace(field.margins, **margins))
    told = doubts([changed_field], small().slider, changed.get("k", 135.2), changed.get("h", 1e-3))
    return {line.partition(":")[0]: line for line in told}


def test_a_margin_that_is_not_small_has_its_sentence(study):
    assert set(doubted(study)) == {"epsilon", "chain", "coupling"}
    assert "would have 2 mu kappa/(kappa_t k h) = 18" in doubted(study)["epsilon"]
    assert "= 0.93, so that points give way" in doubted(study, epsilon=0.93)["epsilon"]
    assert "epsilon" not in doubted(study, epsilon=0.05)
    assert "epsilon" not in doubted(study, k=1e5)
    assert "no wave travels" in doubted(study, epsilon=None, k=None)["epsilon"]
    assert "epsilon" not in doubted(study, k=None)
    sag = doubted(study, sag=30e-6)["sag"]
    assert "what presses at rest bends the beam by 30 µm, 2.1 times the amplitude under the slider" in sag
    assert sag.endswith("which a one-way run leaves out")
    (field,) = study.fields
    slider, harder = small().slider, replace(field.stall, normal_force=3.65 * small().slider.normal_force)
    pressed = replace(field, curve=(harder, *field.curve[1:]), margins=replace(field.margins, sag=30e-6))
    assert "; in the run feet press 3.65 times as much" in " ".join(doubts([pressed], slider, 135.2, 1e-3))
    assert "push away or turn a beam that nothing holds" in doubted(study, sag=None)["sag"]
    size = study.fields[0].amplitude / 1e-3
    assert "climb: points touch for 97 % of the time" in doubted(study, share=0.97)["climb"]
    assert f"of the order of A/h = {size:.2g} of mu times" in doubted(study, share=0.97)["climb"]
    assert "climb" not in doubted(study, share=0.83)
    assert "step" in doubted(study, step=0.4)
    assert "chain" not in doubted(study, chain=1e-4)


def test_facts_print_both_ways_to_a_steady_figure_and_withhold_what_the_spread_hides(study):
    (field,) = study.fields
    shaky = replace(field, free=replace(field.free, spread=0.01))
    first = next(line for line in study.facts() if line.startswith("speed without load"))
    assert f"{100 * field.free.speed:+.5g} cm/s in the free run" in first
    assert f"{100 * field.no_load.speed:+.5g} cm/s held at its place" in first
    second = next(line for line in replace(study, fields=(shaky,)).facts() if line.startswith("speed without load"))
    assert "whether they differ is withheld" in second


# --- Plan, JSON, progress ---------------------------------------------------------------------------------------------


def test_a_run_does_what_its_plan_says():
    scene, told = small(*CHAINED), []
    result = run_scene(replace(scene, gate=()), told.append)
    assert plan_scene(replace(scene, gate=())).motions == result.found["motor"].motions()
    assert len(told) == n_steps(replace(scene, gate=()))
    plain = run_as_plain(result, None)["motor"]
    assert plain["fields"][0]["curve"][0]["force"] == result.found["motor"].fields[0].stall.force
    assert plain["rest"]["fields"][1]["links"] == "rigid"


@pytest.mark.parametrize(("taken", "told"), [(0.009, 0.009), (0.41, 0.41), (3e-14, 0.0)])
def test_what_is_taken_up_of_a_way_is_among_its_figures_however_small(study, taken, told):
    assert at_speed_as_plain(replace(study.fields[0].stall, taken_up=taken))["taken_up"] == told


def test_a_plan_says_that_motion_leaves_such_a_slider_to_the_motor():
    skipped = {one.what: one.why for one in plan_scene(small("motion.duration=1e-3")).skipped}
    assert "which [motor] runs" in skipped["motion study"]
    alone = load_scene("preloaded-motor")
    without = {one.what: one.why for one in plan_scene(replace(alone, motor=None, gate=())).skipped}
    assert without["slider"] == "nothing runs it: add [motor]"


WRONG = {
    "motor.speeds=1": "speeds",
    "motor.periods=3": "periods",
    "motor.chain=-0.1": "motor.chain = -0.1",
    "motor.chain_force=0": "motor.chain_force = 0",
    "motor.modal_damping=1.5": "motor.modal_damping = 1.5",
    "motor.soft_start_periods=2": "motor.soft_start_periods = 2",
    'motor.models=["chain"]': "the nonlinear chain alone",
    'motor.models=["segment", "chian"]': "'chian'.*did you mean 'chain'",
    'motor.models=["segment", "segment"]': "one twice",
    'motor.links=[]': "motor.links = \\[\\]",
    'motor.start="stedy"': "start",
    "motor.places=1": "places",
}  # fmt: skip


@pytest.mark.parametrize("setting", WRONG)
def test_bad_input_is_refused_with_the_scene(setting):
    with pytest.raises(InputError, match=WRONG[setting]):
        load_scene("preloaded-motor", (setting,))


def test_a_run_from_rest_beside_a_chain_is_bounded_by_periods_of_its_drive():
    """By seconds a beam of kilometres was refused a period, and one of micrometres given millions."""
    with pytest.raises(
        InputError, match=r"motor.chain = 0.3 s is 1.28e\+03 periods of the drive: give at most 1000, 0.233 s"
    ):
        load_scene("preloaded-motor", ("motor.chain=0.3",))
    assert load_scene("preloaded-motor", ("motor.chain=0.3", "drive.frequency_hz=2100.0")).motor.chain == 0.3
    assert load_scene("preloaded-motor", ("motor.chain=0.233",)).motor.chain == 0.233  # as it says


def test_a_study_of_a_motor_that_its_beam_feels_is_estimated_as_a_whole(monkeypatch):
    """Each held speed alone is waited for; all of them and the free runs are not."""
    monkeypatch.setenv("VERIFY_PATIENCE", "3")
    felt = small("slider.coupling=two-way", "motor.count=23", "motor.periods=100000")
    with pytest.raises(
        InputError, match=r"motor.periods = 100000 would take about .*, more than the 3 s .* lower it or motor"
    ):
        studied(felt)


@pytest.mark.parametrize("number", [1, 5, 51, 52, 53, 54, 73, 76])
def test_a_run_of_the_study_that_is_broken_off_ends_the_study(monkeypatch, number):
    """One held, of the search, free, cut off, turned round, shot, drawn: the page was of runs that had no end."""
    from verify.motor import carry

    stages, calls = carry.run_stages, iter(range(1, 10**6))

    def broken(*given):
        stopped, *rest = stages(*given)
        return ("interrupted" if next(calls) == number else stopped, *rest)

    monkeypatch.setattr(carry, "run_stages", broken)
    with pytest.raises(KeyboardInterrupt):
        studied(small("motor.count=21", "motor.speeds=2", "motor.periods=20"))


REFUSED = {
    'drive.kind="displacement"': "drive.kind",
    'slider.coupling="two-way"': "slider.coupling = 'two-way' on a nonlinear chain",
    "slider.position=0.03": "off the beam",
    "slider.foot.0.length=0.7": "longer than the beam",
    "beam.loss_factor=0.01": "beam.loss_factor = 0.01: the nonlinear chain moves in time",
    "beam.mass=[{position=0.1, mass=0.01}]": "beam.mass: the nonlinear chain takes none, .* take chain out",
}


@pytest.mark.parametrize("setting", REFUSED)
def test_what_cannot_be_run_is_refused_before_anything_is_solved(setting):
    plan = plan_scene(replace(load_scene("preloaded-motor", (setting,)), gate=()))
    (problem,) = [one for one in plan.problems if one.who == "motor"]
    assert re.search(REFUSED[setting], problem.why)


def test_a_motor_without_forces_or_without_a_slider_that_leaves_is_refused():
    scene = small()
    for changed, words in (
        ({"drive": None}, "under a \\[drive\\] with forces"),
        ({"slider": None}, "add \\[slider\\] with \\[slider.contact\\]"),
        ({"slider": replace(scene.slider, contact=None, foot=())}, "add \\[slider.contact\\]; one that never"),
    ):
        with pytest.raises(InputError, match=words):
            replace(scene, gate=(), **changed)


# --- What is drawn ----------------------------------------------------------------------------------------------------


def test_the_picture_has_a_bar_for_every_point_as_long_as_its_force(study):
    (movie,) = [chart for chart in study.charts() if chart.id == "motor-moving"]
    run = study.drawn.period
    assert len(movie.frames) == len(run.times) - 1
    above = next(line for line in movie.lines if line.name == "force of points above")
    lengths = np.array([[row[3 * i + 1] - row[3 * i] for i in range(5)] for row in above.moves])
    forces = run.pressures[1:, :5]
    assert lengths / lengths.max() == pytest.approx(
        forces / run.pressures[1:].max() * lengths.max() / lengths.max(), abs=0.2
    )
    assert np.corrcoef(lengths.ravel(), forces.ravel())[0, 1] > 1.0 - 1e-9
    assert {len(line.moves) for line in movie.lines} == {len(movie.frames)}


def test_the_contact_line_moves_with_the_crests_by_a_wavelength_a_period(study):
    """The middle of what presses on the upper face, as a phase along the foot, turns once."""
    run = study.drawn.period
    length = 0.0465
    turn = np.exp(2j * pi * run.point_offsets[:5] / length)
    phase = np.unwrap(np.angle(run.pressures[1:, :5] @ turn))
    assert abs(phase[-1] - phase[0]) / (2 * pi) == pytest.approx(35 / 36, abs=0.03)


def test_every_chart_has_something_to_show(study, chained):
    ids = [chart.id for chart in study.charts()]
    assert ids == [
        "motor-moving",
        "motor-force",
        "motor-power",
        "motor-efficiency",
        "motor-portrait",
        "motor-shares",
        "motor-way",
    ]
    assert [chart.id for chart in chained.charts()][-2:] == ["motor-rest", "motor-rest-force"]
    (rest,) = (chart for chart in chained.charts() if chart.id == "motor-rest-force")
    assert rest.lines[0].x[-1] < 0.0
    assert "On the left the wave as the scene says, on the right turned round." in rest.caption
    other = replace(
        chained.rest, fields=tuple(replace(one, curve=one.turned, turned=one.curve) for one in chained.rest.fields)
    )
    caption = next(chart.caption for chart in replace(chained, rest=other).charts() if chart.id == "motor-rest-force")
    assert "On the right the wave as the scene says, on the left turned round." in caption
    assert all(one.drawn > 0.0 for one in chained.rest.fields[1:])
    assert not [chart.id for chart in (*study.charts(), *chained.charts()) if chart.empty]


def test_a_drawing_shows_feet_on_their_faces_and_the_second_beam():
    plain = beam_drawing(load_scene("preloaded-motor"))
    assert "slider on 2 feet" in plain
    assert plain.count('fill="#e8760c"') == 2
    assert plain.count('stroke="#e8760c"') == 30
    several = beam_drawing(load_scene("multi-contact-slider"))
    assert several.count('fill="#e8760c"') == 3
    assert several.count('stroke="#e8760c"') == 44
    assert several.count("stroke-dasharray") == 1


def test_a_free_run_that_is_still_on_its_way_is_told_beside_the_speed_that_is_held(study):
    """Within a hundredth of it one speed is enough."""
    (field,) = study.fields
    for share, told in ((0.995, "runs at"), (0.95, "at the end of its free run, without force at")):
        free = replace(field.free, speed=share * field.no_load.speed)
        assert told in in_short_of(replace(study, fields=(replace(field, free=free),)))


def test_a_field_that_pushes_at_no_speed_has_no_power_and_no_efficiency(study):
    """The other way round it drives: its slider is braked at every speed of the curve."""
    (field,) = study.fields
    assert field.most_power > 0.0
    assert field.best_efficiency > 0.0
    against = [-abs(at.speed) * np.sign(at.force) for at in field.curve]
    braked = replace(
        field, curve=tuple(replace(at, speed=speed) for at, speed in zip(field.curve, against, strict=True))
    )
    assert (braked.most_power, braked.best_efficiency) == (None, None)


def test_a_speed_within_its_own_scatter_has_no_way_and_no_times(study):
    (field,) = study.fields
    still = 3e-5
    for speed, spread, goes in ((still, 0.9 * still, True), (-still, 1.1 * still, False)):
        found = replace(study, fields=(replace(field, free=replace(field.free, speed=speed, spread=spread)),))
        assert (
            "comes to no speed beyond 0.003 cm/s, by which halves of its free run differ," in found.in_short()
        ) != goes
        facts = " ".join(found.facts())
        assert ("withheld, it comes to no speed beyond 0.003 cm/s" in facts) != goes
        overview = found.tables()[0]
        for head in ("start", "stop", "turn"):
            assert (overview.rows[0][[column.head for column in overview.columns].index(head)] is None) != goes


def test_a_force_that_stands_beside_another_that_repeats_itself_is_not_told_alone(study):
    (field,) = study.fields
    assert " or, by how it began," not in study.in_short()
    other = replace(field.shooting, force=0.8 * field.stall.force)
    told = replace(study, fields=(replace(field, shooting=other),)).in_short()
    assert f" or, by how it began, with {in_words(other.force, 'N', '+.4g')} standing still" in told


def test_what_has_not_settled_is_told_with_its_spread_and_what_stands_on_it_is_withheld(study):
    (field,) = study.fields
    shaky = replace(field.stall, unsettled=("force", "powers"), spread=0.007, periods=11520, window=5760)
    free = replace(field.free, settled=False)
    found = replace(study, fields=(replace(field, curve=(shaky, *field.curve[1:]), no_load=None, free=free),))
    assert "comes to no speed" not in " ".join(study.facts())
    assert found.in_short().startswith(
        "The motor does not come to a speed in its free run and bounces so that its force"
    )
    facts = " ".join(found.facts())
    assert "not settled after 11520 periods" in facts
    assert "+- 7 mN as a mean over the last 5760 of them" in facts
    assert "which held speed is without force is withheld" in facts
    assert "withheld, it comes to no speed" in facts
    overview, speeds, *_ = found.tables()
    heads = [column.head for column in overview.columns]
    for head in ("free, cm/s", "stall, N", "start", "stop", "turn"):
        assert overview.rows[0][heads.index(head)] is None
    assert any("means at 1 of 3 held speeds have not settled after 11520 periods" in note for note in overview.notes)
    assert [column.head for column in speeds.columns][1:4] == ["49 segments, mN", "+-, mN", "power, mW"]
    assert speeds.rows[0][2:] == (0.007, None, None)
    assert speeds.records()[0]["+-, N"] == 0.007  # data are in one unit whatever their size
    assert "+-, mN" not in [column.head for column in study.tables()[1].columns]
    force = next(chart for chart in found.charts() if chart.id == "motor-force")
    assert force.lines[-1].y[0] is None
    assert "Left out where its mean has not settled" in force.caption
    shaken = replace(field, curve=tuple(replace(at, unsettled=("force", "powers")) for at in field.curve))
    withheld = {chart.id for chart in replace(study, fields=(shaken,)).charts()}
    assert not withheld & {"motor-force", "motor-power", "motor-efficiency"}
    assert "motor-portrait" in withheld


def test_two_ways_to_one_force_are_no_more_apart_than_rounding(study):
    """Blocks that repeat themselves to the last digit differ by nothing, and 1e-13 of a force is no more than that."""
    (field,) = study.fields
    still = replace(field.stall, spread=0.0)
    for off, told in ((1e-13, ", the same in the motion that repeats itself"), (1e-4, " apart, more than that")):
        shot = replace(still, force=(1.0 + off) * still.force)
        found = replace(study, fields=(replace(field, curve=(still, *field.curve[1:]), shooting=shot),))
        (line,) = (line for line in found.facts() if line.startswith("standing still"))
        assert line.endswith(told)


OF_THE_CHAIN = {
    "motor.chain=0.01": "motor.chain = 0.01",
    "motor.chain_force=3.0": "motor.chain_force = 3.0",
    'motor.links=["stretching"]': "motor.links = \\['stretching'\\]",
    "motor.places=5": "motor.places = 5",
}


@pytest.mark.parametrize("setting", OF_THE_CHAIN)
def test_what_is_of_the_chain_is_refused_without_one(setting):
    """And taken with one; what the file says of it is left out where its models are set to others."""
    with pytest.raises(InputError, match=f"{OF_THE_CHAIN[setting]} is of runs from rest.*add 'chain' there"):
        load_scene("preloaded-motor", ('motor.models=["segment", "fem"]', setting))
    name = setting.partition("=")[0].partition(".")[2]
    kept = load_scene("preloaded-motor", ('motor.models=["segment", "chain"]', setting)).motor
    assert getattr(kept, name) is not None
    assert kept.chain_force == (3.0 if name == "chain_force" else 30.0)
    assert load_scene("preloaded-motor", ('motor.models=["segment"]',)).motor.chain_force is None


THROWN_OFF = """name = "thrown"
[beam]
length = 0.1307029111791325
width = 0.01753741395415265
thickness = 0.006876589524473618
youngs_modulus = 252904462929.53503
density = 1552.5852238346363
[drive]
frequency_hz = 17607.624434826277
force = [
  { position = 0.01307029111791325, amplitude = -2.0 },
  { position = 0.01307029111791325, measured_from = "right", amplitude = 19174623.648624845 },
]
[slider]
mass = 0.0027291516047554857
mu = 0.07613671112430882
position = 0.030061669571200475
preload = 1.2940089707841667
coupling = "one-way"
contact = { stiffness = 69993889.74541315, damping = 0.0 }
[motor]
models = ["segment"]
speeds = 2
periods = 200
"""


def test_a_slider_that_is_thrown_off_in_its_first_periods_has_no_speed_and_is_refused(tmp_path):
    """Of one sample there is no mean: it was 0/0."""
    (tmp_path / "thrown.toml").write_text(THROWN_OFF)
    with pytest.raises(InputError, match=r"motor.start: the free run left the beam within two periods, give smaller"):
        studied(load_scene(str(tmp_path / "thrown.toml")))
