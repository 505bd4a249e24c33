"""Gates of TOML files as pytest items."""

from xml.etree import ElementTree

import pytest

from tests.beams import STRIP, STRIP_TOML
from verify import run_scene
from verify.exact.closed_forms import frequency_hz

SCENE = (
    'name = "mine"'
    + STRIP_TOML
    + """[[gate]]
id = "good"
quantity = "mode.frequency_error"
arguments = { model = "segment", mode = 3, count = 20 }
expect = -3.5e-5
within = 5e-6
why = "mu^4/1440"
[[gate]]
id = "other"
quantity = "mode.bracket"
arguments = { mode = 3, count = 20 }
expect = EXACT
why = "two-sided"
"""
)


@pytest.fixture(scope="module")
def imported(tmp_path_factory):
    """Everything that gates import: numpy can be imported once per process."""
    path = tmp_path_factory.mktemp("first") / "first.toml"
    path.write_text(SCENE.replace("EXACT", "1.0"))
    run_scene(path)


@pytest.fixture
def scene(imported, pytester):
    scene = SCENE.replace("EXACT", repr(frequency_hz(STRIP, 3)))

    def write(name="any name.toml", text=scene, **replaced):
        path = pytester.path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        for old, new in replaced.items():
            text = text.replace(old, new)
        path.write_text(text)
        return path

    return write


def test_gates_of_a_named_file_are_items(pytester, scene):
    done = pytester.runpytest_inprocess(scene(), "-v")
    done.assert_outcomes(passed=2)
    done.stdout.fnmatch_lines(["*any name.toml::good PASSED*"])


def test_gates_are_selected_by_id_and_marker(pytester, scene):
    path = scene("folder/x.toml")
    pytester.makepyfile("def test_plain(): pass")
    pytester.runpytest_inprocess(f"{path}::other").assert_outcomes(passed=1)
    pytester.runpytest_inprocess("-m", "gate", "--strict-markers", ".").assert_outcomes(passed=2, deselected=1)


def test_failing_gate_prints_its_sentence(pytester, scene):
    done = pytester.runpytest_inprocess(scene(**{"-3.5e-5": "-4.5e-5"}))
    done.assert_outcomes(passed=1, failed=1)
    done.stdout.fnmatch_lines(["gate good: -3.6*e-05 lies above -4e-05 (expected -4.5e-05 ± 5e-06; mu^4/1440)"])
    done.stdout.no_fnmatch_line("*Traceback*")


def test_a_passing_gate_of_a_beam_in_millimetres_warns(pytester, scene):
    """A relative error is that of any unit: the gate passes, and says what `verify measure` says."""
    path = scene(
        **{"length = 0.73": "length = 730", "width = 0.031": "width = 31", "thickness = 0.0023": "thickness = 2.3"}
    )
    done = pytester.runpytest_inprocess(f"{path}::good", "-W", "default")
    done.assert_outcomes(passed=1, warnings=1)
    done.stdout.fnmatch_lines(["*gate good: Not to be trusted: a unit is wrong*"])


def test_wrong_scene_is_a_collection_error(pytester, scene):
    done = pytester.runpytest_inprocess(scene(**{"mode.bracket": "mode.brackt"}))
    done.assert_outcomes(errors=1)
    done.stdout.fnmatch_lines(["*did you mean 'mode.bracket'*"])


def test_a_named_scene_that_judges_nothing_is_an_error(pytester, scene):
    bare = SCENE.partition("[[gate]]")[0]
    scene("none.toml", text=bare)
    scene("empty.toml", text="gate = []\n" + bare)
    pytester.makepyfile("def test_plain(): pass")
    pytester.runpytest_inprocess("none.toml", "empty.toml").assert_outcomes(errors=2)
    pytester.runpytest_inprocess(".").assert_outcomes(errors=1)  # none.toml asks for no gates


def test_a_measured_reference_is_one(scene):
    assert run_scene(scene(**{'why = "mu': 'reference = "measured"\nwhy = "mu'})).gates[0].gate.reference == "measured"


def test_other_toml_files_are_left_alone(pytester, scene):
    scene("bad.toml", text="name = ")
    scene("config.toml", text="[tool]\nx = 1\n")
    scene("gates-of-others.toml", text="[[gate]]\nx = 1\n")
    pytester.runpytest_inprocess("bad.toml").assert_outcomes(errors=1)
    pytester.makepyfile("def test_plain(): pass")
    pytester.runpytest_inprocess(".").assert_outcomes(passed=1)


def test_junit_properties_carry_the_value(pytester, scene):
    pytester.runpytest_inprocess(scene(**{"-3.5e-5": "-4.5e-5"}), "--junitxml=out.xml", "-o", "junit_family=xunit2")
    cases = ElementTree.parse(pytester.path / "out.xml").getroot().iter("testcase")
    properties = {c.get("name"): {p.get("name"): p.get("value") for p in c.iter("property")} for c in cases}
    assert float(properties["good"]["measured"]) == pytest.approx(-3.609e-5, abs=1e-8)
    assert properties["good"]["expected"] == "-4.5e-05 ± 5e-06"
    assert float(properties["good"]["fraction"]) > 1.0
    assert "lower" in properties["other"]["measured"]


def test_plugin_imports_nothing_heavy(pytester):
    pytester.makepyfile(
        "import sys\ndef test_light(): assert not {'numpy', 'msgspec', 'verify.scene'} & set(sys.modules)"
    )
    pytester.runpytest_subprocess("-p", "no:hypothesispytest").assert_outcomes(passed=1)
