"""Whatever is given, a command ends with a status and one sentence: hostile scenes, command lines and sizes."""

import json
import math
import os
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from verify import patience
from verify.beam import Beam, PointForce, check_frequency
from verify.cli import status_of
from verify.elements import linear as fem_beam
from verify.errors import SENTENCE, InputError, NoFigureError, near_name, one_line, shown
from verify.exact import modes as analytic_modes
from verify.judge.compare import observed_order, relative_error
from verify.judge.workbench import Workbench
from verify.models import eigen
from verify.motion import rigid_surface
from verify.quantities import described
from verify.quantities.catalogue import QUANTITIES, in_words
from verify.run import gates
from verify.scenes.checked import checked
from verify.scenes.scene import Gate, load_scene
from verify.scenes.toml import literal
from verify.section import Section
from verify.segments import linear as segment_model
from verify.words import figure, number

TITANIUM = {"length": 0.73, "width": 0.031, "thickness": 0.0023, "youngs_modulus": 113e9, "density": 4470.0}
"""SI."""


@pytest.fixture
def verify(capsys, tmp_path, monkeypatch):
    """Run a command line in an empty folder: (status, standard output, error output)."""
    monkeypatch.chdir(tmp_path)

    def call(*words):
        capsys.readouterr()
        status = status_of(list(words))
        out, err = capsys.readouterr()
        return status, out, err

    return call


def refused(verify, *words):
    """The one sentence with which a command line is refused."""
    status, out, err = verify(*words)
    assert status == 2
    assert out == ""
    assert err.startswith("verify: ")
    assert err.count("\n") == 1
    assert len(err) < SENTENCE + 20
    return err


# ------------------------------------------------------------------------------------------- one test for each kind


def test_of_many_names_the_first_are_told_and_how_many_there_are():
    names = [f"name-{n}" for n in range(100, 126)]
    assert near_name("other", names) == f"known are {', '.join(names[:24])} and 2 more"
    assert near_name("other", names[:25]) == f"known are {', '.join(names[:25])}"
    assert near_name("Name-120", names) == "did you mean 'name-120'?"


@pytest.mark.parametrize("step", ["²", "٣", "①", "9" * 5000, "-1"])
def test_a_digit_that_is_no_place_in_a_list_names_no_entry(verify, step):
    assert "names no entry" in refused(verify, "plan", "paper", "--set", f"gate.{step}.why=x")


def test_an_entry_of_a_list_is_found_by_its_number_and_by_its_id():
    by_number = load_scene("paper", ("gate.3.why=seen",)).gate[3]
    assert by_number.why == "seen"
    assert load_scene("paper", (f"gate.{by_number.id}.why=seen",)).gate[3].why == "seen"


@pytest.mark.parametrize("digits", ["1" * 5000, "1" * 31, "0x" + "f" * 5000, str(2**63), str(-(2**63) - 1)])
def test_a_whole_number_beyond_64_bits_is_refused_in_a_file_and_on_the_command_line(verify, tmp_path, digits):
    (tmp_path / "s.toml").write_text(f"name = 'x'\n[spectrum]\nmodes = {digits}\n")
    assert "write a large number as 1e30" in refused(verify, "plan", "s.toml")
    refused(verify, "plan", "paper", "--set", f"spectrum.modes={digits}")
    refused(verify, "choose", "--mode", "2", "--error", digits)
    refused(verify, "measure", "mode.frequency", "model=analytic", f"mode={digits}")


def test_the_largest_whole_numbers_of_toml_are_read(tmp_path):
    assert [literal(str(2**63 - 1)), literal(str(-(2**63)))] == [2**63 - 1, -(2**63)]


def test_a_number_too_large_for_a_float_is_one_sentence_from_python_too():
    for field in TITANIUM:
        with pytest.raises(InputError, match=rf"beam\.{field} = a whole number of 1329 bits"):
            Beam(**TITANIUM | {field: 10**400})
    with pytest.raises(InputError, match="a whole number of 1329 bits"):
        checked({"modes": 10**400}, type(load_scene("paper").convergence))


@pytest.mark.parametrize("name", ["x" * 300, "x" * 5000, "nul\0l.toml", "\ud800.toml"])
def test_what_can_be_no_file_name_is_refused_wherever_a_file_is_named(verify, name):
    for words in (("plan", name), ("init", name), ("run", "free-free-bar", "--reports", name)):
        assert "file name" in refused(verify, *words)


def test_the_name_of_a_scene_is_short_enough_for_its_reports(verify):
    assert "length <= 120" in refused(verify, "plan", "paper", "--set", f"name={'x' * 121}")


def test_a_scene_is_not_written_to_what_looks_like_an_option(verify, tmp_path):
    assert "./--json" in refused(verify, "init", "--", "--json")
    assert verify("init", "./--json")[0] == 0
    assert (tmp_path / "--json").exists()


@pytest.mark.parametrize("where", ["quantity", "sweep", "scene", "argument"])
def test_a_message_shows_a_long_value_by_its_ends(verify, where):
    long = "y" * 6000
    words = {
        "quantity": ("measure", long),
        "sweep": ("table", "paper-wave", "--sweep", long),
        "scene": ("plan", long),
        "argument": ("measure", "mode.frequency", f"model={long}", "mode=1"),
    }[where]
    assert "..." in refused(verify, *words)


def test_a_message_keeps_its_beginning_and_its_remedy_on_one_printable_line():
    text = str(InputError(f"beam.{'a' * 9000}\n\x1b[31m: give a number"))
    assert text.startswith("beam.aaa")
    assert text.endswith("\\n\\x1b[31m: give a number")
    assert len(text) == SENTENCE - 1
    assert one_line("a\tb") == "a\\tb"
    assert shown([10**200, "z" * 500]).startswith("[a whole number of 665 bits, 'zzz")


@pytest.mark.parametrize(
    ("sizes", "figure_named"),
    [
        ({"thickness": 1e-110}, "thickness"),
        ({"thickness": 1e60, "width": 1e-70}, r"youngs_modulus \* width \* thickness\^3"),
        ({"length": 1e-30, "thickness": 1e10}, r"bending stiffness / \(mass per length \* length\^4\)"),
        ({"density": 5e-324}, "density"),
        ({"youngs_modulus": 1.7e308}, "youngs_modulus"),
    ],
)
def test_a_beam_whose_figures_leave_floating_point_is_refused_where_it_is_built(sizes, figure_named):
    with pytest.raises(InputError, match=rf"beam: {figure_named} is about 1e.*check their units"):
        Beam(**TITANIUM | sizes)


def test_a_section_whose_figures_leave_floating_point_is_refused_by_its_number():
    halves = (Section(length=0.4), Section(length=0.33, thickness=1e300))
    with pytest.raises(InputError, match=r"beam\.section\[1\]: thickness is about 1e\+300"):
        Beam(**TITANIUM, section=halves)
    tiny = (Section(length=0.73), Section(length=5e-324, density=3.0))
    with pytest.raises(InputError, match=r"beam\.section\[1\]\.length = 5e-324 m is less than 1e-06"):
        Beam(**TITANIUM, section=tiny)


def test_sections_of_which_one_is_rounding_beside_the_other_are_refused():
    def beam(thickness):
        return Beam(**TITANIUM, section=(Section(length=0.4), Section(length=0.33, thickness=thickness)))

    with pytest.raises(InputError, match=r"beam\.section\[0\] is .*e\+1[5-9] times as stiff .* as beam\.section\[1\]"):
        beam(1e-8)
    assert beam(2.2e-6).stepped  # 1e9 times


def test_a_frequency_whose_waves_cannot_be_followed_is_refused_for_the_drive_and_as_an_argument(verify):
    message = refused(verify, "plan", "paper", "--set", "drive.frequency_hz=1e300")
    assert "drive.frequency_hz = 1e+300 Hz bends this beam in" in message
    for frequency in ("1e300", "1.7e308"):
        assert "waves from end to end" in refused(
            verify, "measure", "wave.reflection", "--scene", "paper-wave", f"frequency_hz={frequency}"
        )
    beam = Beam(**TITANIUM)
    check_frequency("f", 1e13, beam)  # 7e5 waves
    with pytest.raises(InputError, match=r"f = 100000000000000\.0 Hz bends this beam in 1.6e\+06 waves"):
        check_frequency("f", 1e14, beam)


def test_a_window_of_too_many_waves_is_refused_before_its_points_are_made(verify):
    assert "narrow it or lower frequency_hz" in refused(
        verify, "measure", "wave.reflection", "--scene", "paper-wave", "model=analytic", "frequency_hz=3e12"
    )


def test_an_infinite_ratio_is_said_in_words_and_is_null_in_json(verify):
    standing = ("measure", "wave.standing_wave_ratio", "--scene", "paper-wave", "model=analytic", "phase_deg=0")
    assert verify(*standing)[1] == "wave.standing_wave_ratio = infinity\n"
    assert json.loads(verify(*standing, "--json")[1])["value"] is None
    assert (in_words(math.inf), in_words(math.nan), in_words(0.25)) == ("infinity", "no number", "0.25")
    assert (number(math.inf, 4), number(math.nan, 4), figure(2.5)) == ("infinity", "–", "2.5")


def test_a_plan_says_a_surface_at_rest_and_not_an_infinite_share(verify):
    still = ("--set", "drive.force.0.amplitude=0", "--set", "drive.force.1.amplitude=0")
    status, out, _ = verify("plan", "paper-slider", *still)
    assert status == 0
    assert "the drive does not move the surface under the slider" in " ".join(out.split())
    assert " inf " not in out


@pytest.mark.parametrize(("given_as", "said"), [("nan", "not a number"), ("inf", "infinity"), ("-inf", "-infinity")])
def test_a_plan_says_in_words_that_an_argument_is_no_number(verify, given_as, said):
    status, out, _ = verify("plan", "paper", "--set", f"gate.segment-mode-22.arguments.count={given_as}")
    assert status == 1
    assert f"count = {said}: give a whole number" in " ".join(out.split())


def test_a_table_of_figures_says_infinity_in_a_word(verify):
    standing = ("--set", "drive.force.1.phase_deg=0", "--counts", "49")
    for layout in ("--csv", "--markdown"):
        status, out, _ = verify("table", "paper-wave", "--wave", layout, *standing)
        assert status == 0
        assert not re.search(r"\binf\b", out)
        assert "nan" not in out


def test_a_folder_with_a_strange_name_is_printed_as_it_is(verify, tmp_path):
    status, out, _ = verify("run", "free-free-bar", "--reports", "a[/]b")
    assert status == 0
    assert f"report: {os.path.join('a[/]b', 'free-free-bar.html')}" in out
    assert (tmp_path / "a[/]b" / "free-free-bar.html").exists()


def test_an_error_relative_to_nothing_is_refused():
    assert relative_error(3.0, 2.0) == 0.5
    assert relative_error(1j, 2.0 + 0j) == pytest.approx(-1 + 0.5j)
    for nothing in (0.0, 0j, math.inf, math.nan):
        with pytest.raises(NoFigureError, match="no error is relative to it"):
            relative_error(3.0, nothing)
    with pytest.raises(InputError, match="not finite is rounding, or of an infinite figure"):
        observed_order((10, 20, 40), (0.1, math.nan, 0.01))


def test_the_error_of_a_slider_that_does_not_move_is_refused(verify):
    still = ("--set", "drive.force.0.amplitude=0", "--set", "drive.force.1.amplitude=0")
    assert "does not move" in refused(verify, "table", "paper-slider", "--slider", "--counts", "9", *still)


def test_a_slider_that_is_gone_before_the_first_sample_has_no_mean_speed(verify):
    away = ("--set", "slider.position=0.5", "--set", "slider.speed=1e3", "--set", "motion.samples=2")
    refused(verify, "table", "paper-slider", "--slider", "--counts", "9", *away)


def test_more_modes_than_a_spectrum_can_show_are_refused_before_they_are_listed(verify):
    assert "<= 10000" in refused(verify, "run", "paper", "--no-report", "--set", "spectrum.modes=1000000000")


# --------------------------------------------------------------------------------------------- work before it begins


def test_a_solve_that_would_take_too_long_is_refused_with_its_time(verify):
    for words in (
        ("measure", "mode.frequency", "model=segment", "mode=1", "count=4000000"),
        ("table", "paper", "--modes", "1", "--counts", "20,2000000"),
        ("table", "paper-wave", "--wave", "--counts", "49,300000"),
        ("table", "paper-wave", "--sweep", "count=2:900000:9", "--quantity", "wave.reflection", "model=fem"),
        ("measure", "wave.best_frequency", "--scene", "paper-wave", "model=segment", "count=200000"),
        ("measure", "mode.frequency", "model=fem", "mode=3000", "count=5000"),
    ):
        message = refused(verify, *words)
        assert "VERIFY_PATIENCE" in message or "GiB" in message


def test_an_estimate_of_time_grows_with_unknowns_and_modes_and_lies_above_what_was_measured():
    assert eigen.solve_seconds(100_000, 22) > 0.84  # segments; 2.4 s for the 200 000 unknowns of Hermite elements
    assert eigen.solve_seconds(200_000, 22) > 2.4
    assert eigen.solve_seconds(2_000_000, 5) > 38.0  # a million elements
    assert eigen.solve_seconds(2000, 1000) > 4.6  # dense
    assert eigen.solve_seconds(200_000, 22) < 10.0
    assert eigen.solve_seconds(200_000, 44) > 1.3 * eigen.solve_seconds(200_000, 22)


def test_a_long_run_of_a_slider_is_refused_with_its_time(verify):
    assert "minutes" in refused(
        verify, "measure", "slider.displacement", "--scene", "paper-slider", "count=49", "time=400"
    )


def test_patience_is_the_users_to_give(monkeypatch):
    with pytest.raises(InputError, match=r"n = 7 would take about 50 s, more than the 20 s .* VERIFY_PATIENCE"):
        patience.check_work("n", 7, 50.0, "lower n")
    with pytest.raises(InputError, match=r"^duration = 30 would take about"):
        patience.check_work("duration", 30.000000000000004, 50.0, "shorten it")
    monkeypatch.setenv(patience.VARIABLE, "60")
    patience.check_work("n", 7, 50.0, "lower n")
    with pytest.raises(InputError, match="would take about 28 hours, more than the 60 s"):
        patience.check_work("n", 7, 1e5, "lower n")
    for wrong in ("soon", "0", "-3", "nan"):
        monkeypatch.setenv(patience.VARIABLE, wrong)
        with pytest.raises(InputError, match="give seconds above 0"):
            patience.check_work("n", 7, 1.0, "lower n")


def test_a_belt_that_stretches_its_spring_for_very_long_is_refused():
    with pytest.raises(InputError, match="raise speed"):
        rigid_surface.stick_slip_times(1.5e-10, 1.2e8, 2146.3, 0.18, 0.777)


# ----------------------------------------------------------------------------------------------- gates keep their word


def test_a_gate_shows_no_exception_of_the_suites_own(monkeypatch):
    scene = load_scene("paper")

    def broken(*_):
        raise IndexError("index 0 is out of bounds for axis 0 with size 0")

    for model in (segment_model, fem_beam):
        monkeypatch.setattr(model, "lowest", broken)
    gate = Gate(
        id="g",
        quantity="mode.order",
        arguments={"model": "fem", "mode": 2, "counts": [9, 12, 17]},
        at_least=1.0,
        why="test",
    )
    found = gates.judge(gate, scene, Workbench(scene.beam))
    assert not found.passed
    assert "IndexError" not in found.reason
    assert "axis" not in found.reason
    assert "mode.order" in found.reason


def test_a_gate_on_an_infinite_figure_fails_in_words():
    scene = load_scene("paper-wave")
    gate = Gate(
        id="g",
        quantity="wave.standing_wave_ratio",
        arguments={"model": "analytic", "phase_deg": 0.0},
        at_least=1.0,
        why="test",
    )
    found = gates.judge(gate, scene, Workbench(scene.beam))
    assert not found.passed
    assert found.reason == "measured infinity, which is not a finite real number"


# -------------------------------------------------------------------------------------------- what is not narrowed

legitimate = st.fixed_dictionaries(
    {
        "length": st.floats(-9.0, 3.0).map(lambda p: 10**p),
        "slender": st.floats(-6.0, 0.0).map(lambda p: 10**p),
        "wide": st.floats(-4.0, 1.0).map(lambda p: 10**p),
        "youngs_modulus": st.floats(0.0, 15.0).map(lambda p: 10**p),
        "density": st.floats(-3.0, 5.0).map(lambda p: 10**p),
    }
)


def beam_of(sizes):
    """A beam from its length and two ratios."""
    length = sizes["length"]
    return Beam(
        length=length,
        width=length * sizes["wide"],
        thickness=length * sizes["slender"],
        youngs_modulus=sizes["youngs_modulus"],
        density=sizes["density"],
    )


@settings(max_examples=60, deadline=None)
@given(legitimate, st.integers(1, 7), st.sampled_from(["segment", "fem"]))
def test_beams_from_nanometres_to_kilometres_of_any_modulus_have_their_frequencies_to_all_digits(sizes, mode, model):
    beam = beam_of(sizes)
    exact = (
        math.pi * mode**2 / 2.0 / beam.length**2 * math.sqrt(beam.youngs_modulus / beam.density / 12.0) * beam.thickness
    )
    assert analytic_modes.exact_frequency_hz(beam, mode) == pytest.approx(exact, rel=1e-14)
    solve = {"segment": segment_model.solve_modes, "fem": fem_beam.solve_modes}[model]
    here, there = (solve(b, mode, 11).frequencies_hz[-1] for b in (beam, Beam(**TITANIUM)))
    reference = analytic_modes.exact_frequency_hz(Beam(**TITANIUM), mode)
    assert here / exact == pytest.approx(there / reference, rel=1e-12)


@settings(max_examples=30, deadline=None)
@given(legitimate, st.floats(0.61, 5.3), st.floats(0.03, 0.97))
def test_the_driven_beam_has_the_same_figures_in_any_unit(sizes, turns, at):
    """Deflection times EI / (F L^3) is a number of frequency and place alone."""

    def deflection(beam):
        frequency = turns**2 * analytic_modes.exact_frequency_hz(beam, 1)
        force = PointForce(position=at * beam.length, amplitude=1.7)
        field = analytic_modes.solve_harmonic(replace(beam, loss_factor=0.02), [force], frequency)
        return field.deflection([0.37 * beam.length])[0] * beam.bending_stiffness / beam.length**3

    assert deflection(beam_of(sizes)) == pytest.approx(deflection(Beam(**TITANIUM)), rel=1e-9)


@settings(max_examples=25, deadline=None)
@given(st.floats(-4.0, 3.0), st.floats(0.11, 0.83), st.floats(-5.0, 5.0))
def test_stepped_beams_of_very_unlike_sections_keep_their_exact_frequency(contrast, part, heavier):
    """Two sections in either order from either end: the mirrored beam has the same frequency."""
    sections = (
        Section(length=0.73 * part, youngs_modulus=113e9 * 10**contrast),
        Section(length=0.73 * (1.0 - part), density=4470.0 * 10**heavier),
    )
    beam = Beam(**TITANIUM, section=sections, supports=("clamped", "pinned"))
    here, there = (analytic_modes.stepped_frequency_hz(b, 2) for b in (beam, beam.mirrored()))
    assert here == pytest.approx(there, rel=1e-7)


# ------------------------------------------------------------------------------------ hostile scenes and command lines

STRANGE_NUMBERS = [0, -0.0, -1, 3, 1e-300, 5e-324, 1.7e308, -1e300, math.inf, math.nan, 2**63 - 1, 2**64, 10**40, 0.3]
STRANGE_WORDS = ["", "text", "é²", "a\nb", "nul\0l", "z" * 700, "[red]", "1e5", "../x", "%s{}", "\x1b[2J", "--json"]
strange = st.one_of(
    st.sampled_from([*STRANGE_NUMBERS, *STRANGE_WORDS, True, (), (1, 2), ("pinned",)]),
    st.floats(),
    st.integers(-(2**70), 2**70),
    st.text(max_size=12),
)
ADDRESSES = [
    "name",
    "title",
    "beam",
    "beam.length",
    "beam.width",
    "beam.thickness",
    "beam.youngs_modulus",
    "beam.density",
    "beam.supports",
    "beam.loss_factor",
    "beam.section",
    "drive.frequency_hz",
    "drive.force.0.position",
    "drive.force.1.amplitude",
    "drive.force.1.phase_deg",
    "drive.kind",
    "spectrum.modes",
    "spectrum.count",
    "convergence.counts",
    "sensitivity.mode",
    "wave.counts",
    "wave.frequency_hz",
    "slider.mass",
    "slider.mu",
    "slider.position",
    "motion.duration",
    "motion.samples",
    "motion.steps_per_period",
    "gate.0.expect",
    "gate.0.within",
    "gate.²",
    "gate",
    "nonsense",
    "a..b",
    "",
    "beam.length.x",
]


def as_toml(value):
    """A value as TOML writes it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value)
    return "[" + ", ".join(map(as_toml, value)) + "]" if isinstance(value, tuple) else repr(value)


def ends_well(words, folder):
    """Run a command line; its status is one of three, and a refusal is one line for each thing that is wrong."""
    import contextlib
    import io

    out, err, home = io.StringIO(), io.StringIO(), os.getcwd()
    os.chdir(folder)
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), np.errstate(all="ignore"):
            status = status_of(words)
    finally:
        os.chdir(home)
    assert status in (0, 1, 2)
    if status == 2 and err.getvalue().startswith("verify: "):
        lines = err.getvalue().splitlines()
        assert 1 <= len(set(lines)) == len(lines) <= 31
        assert all(line.startswith("verify: ") and len(line) < SENTENCE + 20 for line in lines)
    elif status == 2:
        assert err.getvalue().startswith("Usage: ")
    elif "--json" in words:
        json.loads(out.getvalue(), parse_constant=pytest.fail)
    assert "fails on it" not in out.getvalue()
    return status


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Where nothing is."""
    return tmp_path_factory.mktemp("hostile")


@settings(max_examples=250, deadline=None, derandomize=True)
@given(
    st.sampled_from(["paper", "paper-wave", "paper-slider", "stepped-beam", "steel-cantilever", "chain"]),
    st.lists(st.tuples(st.sampled_from(ADDRESSES), strange), min_size=1, max_size=3),
    st.booleans(),
)
def test_a_plan_of_a_scene_with_anything_in_it_is_a_plan_or_one_sentence(folder, scene, changes, as_json):
    words = [word for field, value in changes for word in ("--set", f"{field}={as_toml(value)}")]
    ends_well(["plan", scene, *words, *["--json"] * as_json], folder)


@st.composite
def questions(draw):
    """A quantity with some of its arguments, most of them of a likely kind."""
    name = draw(st.sampled_from([name for name in QUANTITIES if not name.startswith("chain.")]))
    likely = {
        "mode": st.integers(1, 9),
        "modes": st.integers(1, 30),
        "count": st.integers(1, 40),
        "node": st.integers(1, 3),
        "counts": st.just((7, 12, 19)),
        "model": st.sampled_from(["analytic", "fem", "segment"]),
        "error": st.floats(1e-6, 0.5),
        "frequency_hz": st.floats(1.0, 9e3),
        "time": st.floats(1e-5, 2e-3),
        "window": st.just((0.11, 0.37)),
        "x": st.floats(0.0, 0.5),
    }
    given = {}
    for argument in QUANTITIES[name].arguments.__struct_fields__:
        if argument in ("model", "mode", "count") or draw(st.booleans()):
            kind = likely.get(argument, st.floats(1e-3, 1e3))
            given[argument] = draw(strange) if draw(st.integers(0, 7)) == 0 else draw(kind)
    return name, given


@settings(max_examples=200, deadline=None, derandomize=True)
@given(questions(), st.sampled_from(["paper-slider", "paper-wave", "stepped-beam"]), st.booleans())
def test_any_quantity_asked_with_anything_is_a_figure_or_one_sentence(folder, question, scene, as_json):
    name, given = question
    words = [f"{key}={as_toml(value)}" for key, value in given.items()]
    ends_well(["measure", name, *words, "--scene", scene, *["--json"] * as_json], folder)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.binary(max_size=60), st.sampled_from(["plan", "run"]))
def test_a_file_of_any_bytes_is_one_sentence(folder, data, command):
    (folder / "bytes.toml").write_bytes(data)
    assert ends_well([command, "bytes.toml"], folder) == 2


@settings(max_examples=80, deadline=None, derandomize=True)
@given(
    st.lists(
        st.sampled_from(
            [
                "plan",
                "measure",
                "choose",
                "table",
                "init",
                "paper",
                "--set",
                "--sweep",
                "--mode",
                "2",
                "--counts",
                "1,2",
                "x=1",
                "",
                "=",
                "²",
                "a\0b",
                "z" * 400,
                "--json",
                "--error",
                "1%",
            ]
        ),
        min_size=1,
        max_size=6,
    ),
)
def test_any_order_of_words_is_a_command_or_one_refusal(folder, words):
    ends_well(words, folder)


@pytest.mark.parametrize("layout", ["csv", "markdown"])
def test_an_endless_ratio_is_a_word_in_every_layout(layout):
    from verify.report.plain import rows_as_text

    told = rows_as_text([{"ratio": float("inf"), "way": -float("inf"), "none": None, "size": 0.3}], layout)
    cells = told.splitlines()[-1].strip("| ").replace(" ", "").replace("|", ",").split(",")
    assert cells == ["infinity", "-infinity", "", "0.3"]


def test_a_key_that_a_complex_expectation_has_not_is_named(verify):
    said = refused(verify, "plan", "paper", "--set", "gate.exact-mode-22.expect={a=1}")
    assert "expect.a is not a known key" in said
    assert "re" in said


def test_a_wave_that_throws_the_slider_to_infinity_is_refused(verify):
    given = ("amplitude=0.021", "slope=0.0012", "mu=4.65", "kinematics=following", "frequency_hz=135752.2")
    thin = (
        "--set",
        "beam.thickness=0.00021924",
        "--set",
        "beam.youngs_modulus=264380115293.2",
        "--set",
        "beam.density=9940.6",
    )
    assert "amplitude = 0.021 m" in refused(
        verify, "measure", "slider.terminal_speed", *given, "--scene", "paper", *thin
    )


def test_a_force_too_small_to_square_is_refused(verify):
    given = ("segments=2", "force=1e-300", "--scene", "paper-wave")
    assert "give a larger force" in refused(verify, "measure", "chain.axial_departure", *given)


def test_a_short_chain_over_a_long_time_is_refused_for_its_work(verify):
    """Three links for two days: an evaluation costs more than its links."""
    given = ("segments=3", "time=156903.0", "x=4.5", "inertia=transverse", "--scene", "paper-wave")
    beam = ("--set", "beam.length=8.565", "--set", "beam.width=1.995", "--set", "beam.thickness=0.0425")
    drive = ("--set", "drive.frequency_hz=3.2e-6")
    assert "accelerations of links" in refused(verify, "measure", "chain.transient_deflection", *given, *beam, *drive)


# ---------------------------------------------------------------------------------- tables, maps, drives of any size


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("paper", "--of", "convergence", "--counts", "7"), "--counts belongs to the table of all models or --wave"),
        (("paper", "--of", "convergence", "--modes", "7"), "--modes belongs to the table of all models: leave it out"),
        (("paper-wave", "--wave", "--modes", "3"), "leave it out beside --wave"),
        (("paper-wave", "--sweep", "phase_deg=0:90:2", "--counts", "3"), "leave it out beside --sweep"),
        (("paper-wave", "--quantity", "wave.reflection"), "--quantity belongs to --sweep"),
        (("paper-slider", "--wave", "--slider"), "--slider and --wave ask for two tables"),
        (("paper", "--json", "--csv"), "--json and --csv are two ways to print one table: give one of them"),
        (("paper-wave", "--of", "wave", "--sweep", "phase_deg=0:90:2"), "--of and --sweep ask for two tables"),
        (("paper", "--of", "convergense"), "--of = 'convergense' is not known: did you mean 'convergence'?"),
        (("paper", "--of", "wave"), "--of wave: the scene has no [wave]"),
        (("paper", "--of", "sensitivity"), "ask for --csv, --markdown or --json"),
    ],
)
def test_a_table_takes_no_option_that_would_change_nothing(verify, words, said):
    assert said in refused(verify, "table", *words)


def test_a_study_told_in_charts_has_rows_for_other_programs(verify):
    spectrum = verify("table", "paper", "--of", "spectrum", "--csv")[1].splitlines()
    assert spectrum[0] == "mode,count,segment_error,fem_error,rayleigh_error,timoshenko_error,plate_error"
    last = load_scene("paper").spectrum.modes
    assert [row.split(",")[0] for row in spectrum[1:]] == [str(mode) for mode in range(1, last + 1)]
    assert float(spectrum[22].split(",")[2]) == pytest.approx(-4.28e-3, rel=1e-3)
    rows = [row.split(",") for row in verify("table", "paper", "--of", "sensitivity", "--csv")[1].splitlines()[1:]]
    beam = load_scene("paper").beam
    for mode, modulus, density, hertz in [rows[7], rows[63]]:
        changed = replace(beam, youngs_modulus=float(modulus), density=float(density))
        assert float(hertz) == pytest.approx(analytic_modes.exact_frequency_hz(changed, int(mode)), rel=1e-12)


def test_claims_about_a_run_are_found_on_it_in_a_table_too(verify):
    status, out, _ = verify("table", "paper-slider", "--of", "claims", "--json")
    claims = {claim["id"]: claim for claim in json.loads(out)}
    assert status == 0
    assert claims["to-the-left"]["reason"] == ""
    assert claims["to-the-left"]["found"] == pytest.approx(-1.3833e-9, rel=1e-4)


def test_a_map_point_by_point_is_refused_for_the_time_of_all_its_points(verify):
    fine = ("--sweep", "frequency_hz=4000:4600:241", "--sweep", "phase_deg=0:180:121")
    words = ("--quantity", "wave.signed_area_spread", "model=segment", "count=49")
    assert "points of the map = 29161 would take about 5 minutes" in refused(
        verify, "table", "paper-wave", *fine, *words
    )
    few = ("--sweep", "frequency_hz=4000:4600:2", "--sweep", "phase_deg=30:70:2", "--csv")
    assert verify("table", "paper-wave", *few, *words)[0] == 0


@pytest.mark.filterwarnings("error")
def test_a_force_whose_figures_leave_floating_point_is_refused_with_the_slope_it_makes(verify):
    huge = ("--scene", "paper-slider", "--set", "drive.force.0.amplitude=1e300")
    for quantity in ("slider.displacement", "wave.energy_flux", "motion.deflection"):
        given = ("x=0.2",) if quantity == "motion.deflection" else ()
        message = refused(verify, "measure", quantity, "model=analytic", *given, *huge)
        assert "force.amplitude = 1e+300 N bends this beam to slopes of about 2e+300" in message
    beam = Beam(**TITANIUM)
    drive = [PointForce(position=0.21, amplitude=1e99 * beam.bending_stiffness / beam.length**2)]
    assert math.isfinite(abs(analytic_modes.solve_harmonic(beam, drive, 433.0).slope([0.3])[0]) ** 2)


@pytest.mark.filterwarnings("error")
def test_the_reflection_below_a_hertz_changes_over_half_of_its_frequency(verify):
    """Of a strip as thin as a thousandth of the paper's, whose waves of 0.4 Hz are shorter than it is."""
    slow = ("--scene", "paper-wave", "--set", "beam.thickness=1e-6", "model=analytic", "loss_factor=0.03")
    measured = verify("measure", "wave.reflection_per_hertz", *slow, "frequency_hz=0.4", "--json")[1]
    here, below, above = (
        json.loads(verify("measure", "wave.reflection", *slow, f"frequency_hz={f}", "--json")[1])["value"]
        for f in (0.4, 0.2, 0.6)
    )
    assert json.loads(measured)["value"] == pytest.approx((abs(above - here) + abs(below - here)) / 0.4, rel=1e-6)


@pytest.mark.parametrize("given", ["FEM", "Fem", "fen"])
def test_every_quantity_that_takes_a_model_names_the_nearest_whatever_its_letters(verify, given):
    asked = {q["quantity"]: q["arguments"] for q in described() if "model" in {a["name"] for a in q["arguments"]}}
    assert len(asked) > 30
    for quantity, arguments in asked.items():
        words = [f"{a['name']}=2" for a in arguments if a["required"] and a["name"] != "model"]
        message = refused(verify, "measure", quantity, f"model={given}", *words)
        assert f"model = '{given}' is not known: did you mean 'fem'?" in message


def test_the_mean_of_a_bracket_is_a_model_where_a_figure_says_so_and_nowhere_else(verify):
    for one in described():
        models = next((a["type"].split(" | ") for a in one["arguments"] if a["name"] == "model"), None)
        if models and "mean" not in models:
            words = [f"{a['name']}=2" for a in one["arguments"] if a["required"] and a["name"] != "model"]
            message = refused(verify, "measure", one["quantity"], "model=mean", *words)
            assert f"model = 'mean' is not known: known are {', '.join(models)}" in message
    mean = ("measure", "mode.frequency", "mode=3", "count=17")
    assert "did you mean 'mean'?" in refused(verify, *mean, "model=maen")
    assert verify(*mean, "model=mean")[0] == 0
