"""Gates of TOML files as pytest items, run in a pytest of their own."""

from xml.etree import ElementTree

import pytest

SCENE = """
name = "mine"
[beam]
length = 0.73
width = 0.031
thickness = 0.0023
youngs_modulus = 113e9
density = 4470
[[gate]]
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


@pytest.fixture
def scene(pytester):
    from verify import Beam
    from verify.exact.closed_forms import frequency_hz

    beam = Beam(length=0.73, width=0.031, thickness=0.0023, youngs_modulus=113e9, density=4470.0)
    text = SCENE.replace("EXACT", repr(frequency_hz(beam, 3)))

    def write(name="any name.toml", text=text, **replaced):
        path = pytester.path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        for old, new in replaced.items():
            text = text.replace(old, new)
        path.write_text(text)
        return path

    return write


def test_gates_of_a_named_file_are_items_whatever_its_name(pytester, scene):
    done = pytester.runpytest_subprocess(scene(), "-v")
    done.assert_outcomes(passed=2)
    done.stdout.fnmatch_lines(["*any name.toml::good PASSED*"])


def test_gates_are_selected_by_id_and_by_marker(pytester, scene):
    path = scene("folder/x.toml")
    pytester.makepyfile("def test_plain(): pass")
    pytester.runpytest_subprocess(f"{path}::other").assert_outcomes(passed=1)
    pytester.runpytest_subprocess("-m", "gate", "--strict-markers", ".").assert_outcomes(passed=2, deselected=1)
    pytester.runpytest_subprocess("-k", "good", path).assert_outcomes(passed=1, deselected=1)


def test_a_failing_gate_shows_its_sentence_and_no_traceback(pytester, scene):
    done = pytester.runpytest_subprocess(scene(**{"-3.5e-5": "-4.5e-5"}))
    done.assert_outcomes(passed=1, failed=1)
    done.stdout.fnmatch_lines(
        ["gate good: measured -3.6*e-05 lies above -4e-05 (expected -4.5e-05 ± 5e-06; mu^4/1440)"]
    )
    done.stdout.no_fnmatch_line("*Traceback*")
    done.stdout.no_fnmatch_line("*pytest_plugin.py*GateFailedError*")


def test_a_gate_that_cannot_be_evaluated_fails(pytester, scene):
    done = pytester.runpytest_subprocess(scene(**{"mode.bracket": "mode.brackt"}))
    done.assert_outcomes(passed=1, failed=1)
    done.stdout.fnmatch_lines(["*did you mean 'mode.bracket'*"])


def test_a_broken_scene_is_a_collection_error_with_its_sentence(pytester, scene):
    done = pytester.runpytest_subprocess(scene(**{"length = 0.73": "lenght = 0.73"}))
    done.assert_outcomes(errors=1)
    done.stdout.fnmatch_lines(["*beam.lenght is not a known key: did you mean 'length'?*"])
    assert done.ret != 0


def test_a_named_file_that_is_no_toml_is_an_error_and_others_are_left_alone(pytester, scene):
    scene("bad.toml", text="name = ")
    scene("config.toml", text="[tool]\nx = 1\n")
    scene("gates-of-others.toml", text="[[gate]]\nx = 1\n")
    done = pytester.runpytest_subprocess("bad.toml")
    done.assert_outcomes(errors=1)
    pytester.makepyfile("def test_plain(): pass")
    pytester.runpytest_subprocess(".").assert_outcomes(passed=1)


def test_junit_properties_carry_the_measurement(pytester, scene):
    pytester.runpytest_subprocess(scene(**{"-3.5e-5": "-4.5e-5"}), "--junitxml=out.xml", "-o", "junit_family=xunit2")
    cases = ElementTree.parse(pytester.path / "out.xml").getroot().iter("testcase")
    properties = {c.get("name"): {p.get("name"): p.get("value") for p in c.iter("property")} for c in cases}
    good = properties["good"]
    assert float(good["measured"]) == pytest.approx(-3.609e-5, abs=1e-8)
    assert (float(good["expect"]), float(good["within"])) == (-4.5e-5, 5e-6)
    assert good["band"] == "-4.5e-05 ± 5e-06"
    assert float(good["share_of_band_used"]) > 1
    assert float(good["seconds"]) > 0
    assert "lower" in properties["other"]["measured"]


def test_xdist_workers_agree_on_the_gates(pytester, scene):
    pytester.runpytest_subprocess(scene(), "-n", "2").assert_outcomes(passed=2)


def test_the_plugin_imports_nothing_heavy_in_a_project_without_scenes(pytester):
    pytester.makepyfile(
        "import sys\ndef test_light(): assert not {'numpy', 'msgspec', 'verify.scene'} & set(sys.modules)"
    )
    pytester.runpytest_subprocess("-p", "no:hypothesispytest").assert_outcomes(passed=1)


def test_a_patience_that_is_none_is_a_collection_error(pytester, scene, monkeypatch):
    monkeypatch.setenv("VERIFY_PATIENCE", "-3")
    scene("mine.toml")
    result = pytester.runpytest("mine.toml")
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["*VERIFY_PATIENCE = '-3': give seconds above 0*"])
