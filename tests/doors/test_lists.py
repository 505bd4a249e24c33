"""What there is to ask for, as users of the command line meet it: keys, schema, scenes shown and copied, quantities."""

import json
import tomllib

import pytest


@pytest.fixture
def verify(verify, monkeypatch):
    """As everywhere, in a narrow terminal."""
    monkeypatch.setenv("COLUMNS", "80")
    return verify


def words_of(text):
    return " ".join(text.split())


def test_the_schema_is_printed_or_written_and_the_starter_names_it(verify, tmp_path):
    status, out, _ = verify("schema")
    assert status == 0
    printed = json.loads(out)
    assert printed["additionalProperties"] is False
    assert verify("schema", "--to", "verify.schema.json")[0] == 0
    assert json.loads((tmp_path / "verify.schema.json").read_text("utf-8")) == printed
    verify("init", "mine.toml")
    first = (tmp_path / "mine.toml").read_text("utf-8").splitlines()[0]
    assert first == "#:schema ./verify.schema.json"


def test_a_section_alone_has_a_schema_and_an_unknown_one_a_sentence(verify):
    assert set(json.loads(verify("schema", "--section", "beam.mass")[1])["properties"]) == {
        "position",
        "mass",
        "rotary_inertia",
    }
    assert verify("schema", "--section", "bem")[2].startswith(
        "verify: section = 'bem' is not known: did you mean 'beam'?"
    )


@pytest.mark.parametrize("section", ["scene", "beam", "slider", "wave", "gate"])
def test_keys_stand_in_eighty_columns_with_default_and_meaning(verify, section):
    status, out, _ = verify("keys", section)
    assert status == 0
    assert max(len(line.rstrip()) for line in out.splitlines()) <= 80
    for key in json.loads(verify("keys", section, "--json")[1]):
        assert f" {key['key']} " in out


def test_keys_without_a_section_lists_the_sections(verify):
    listed = json.loads(verify("keys", "--json")[1])
    assert {one["section"]: one["keys"] for one in listed}["beam.spring"] == 3
    out = verify("keys")[1]
    assert "beam.spring" in out
    assert "Raises" not in out


def test_a_scene_is_copied_under_the_name_of_its_file(verify, tmp_path):
    assert verify("init", "my beam.toml", "--from", "steel-cantilever")[0] == 0
    copied = tomllib.loads((tmp_path / "my beam.toml").read_text("utf-8"))
    assert copied["name"] == "my-beam"
    assert copied["beam"]["supports"] == ["clamped", "free"]
    assert verify("plan", "my beam.toml")[0] == 0
    assert "did you mean 'stepped-beam'" in verify("init", "x.toml", "--from", "steped-beam")[2]
    assert "--force" in verify("init", "my beam.toml", "--from", "paper")[2]


def test_a_scene_is_shown_as_written_and_with_overrides_as_read(verify):
    from verify.scenes.scene import scene_path

    assert verify("show", "paper")[1] == scene_path("paper").read_text("utf-8")
    _, out, _ = verify("show", "paper", "--set", "beam.length=0.4", "--set", "convergence.modes=2-4")
    shown = tomllib.loads(out)
    assert (shown["beam"]["length"], shown["convergence"]["modes"]) == (0.4, [2, 3, 4])
    assert json.loads(verify("show", "paper", "--set", "beam.length=0.4", "--json")[1])["beam"]["length"] == 0.4
    assert verify("show", "paper", "--set", "beam.lenght=0.4")[0] == 2


def test_quantities_are_filtered_by_all_the_words(verify):
    names = [one["quantity"] for one in json.loads(verify("quantities", "MODE", "order", "--json")[1])]
    assert names == ["mode.order", "mode.shape_order", "wave.order", "slider.order"]
    status, _, err = verify("quantities", "nonsense")
    assert (status, err) == (2, "verify: no quantity is told with 'nonsense': leave a word out, or all of them\n")


def test_an_argument_that_quantities_share_is_told_once(verify):
    out = verify("quantities", "mode.")[1]
    assert words_of(out).count("default gregory.") == 1
    assert "arguments of several of these" in out
    assert max(len(line) for line in out.splitlines() if line.startswith(" ")) <= 80


def test_a_filtered_quantity_alone_shares_nothing(verify):
    out = verify("quantities", "coulomb_decrement")[1]
    assert "arguments of several" not in out
    assert "stiffness     number; required" in out


def test_every_argument_of_every_quantity_is_told_somewhere(verify):
    told = words_of(verify("quantities")[1])
    for one in json.loads(verify("quantities", "--json")[1]):
        for argument in one["arguments"]:
            assert words_of(f"{argument['name']} {argument['type']}; ") in told, argument


def test_a_range_and_its_numbers_ask_for_the_same_table(verify):
    spelt = json.loads(verify("table", "paper", "--modes", "3,4,5", "--counts", "8,16,24", "--json")[1])
    ranged = json.loads(verify("table", "paper", "--modes", "3-5", "--counts", "8-24:8", "--json")[1])
    assert [(row["mode"], row["count"]) for row in ranged] == [(row["mode"], row["count"]) for row in spelt]
    assert verify("table", "paper", "--modes", "5-3")[2] == (
        "verify: modes = '5-3' is an empty range: write it upwards, 1-5 or 10-50:10\n"
    )


def test_a_per_cent_is_what_a_relative_number_takes(verify):
    asked = ("measure", "mode.count_needed", "model=segment", "mode=5")
    assert verify(*asked, "error=0.1%")[1] == verify(*asked, "error=0.001")[1] != verify(*asked, "error=1%")[1]
    status, _, err = verify("run", "paper", "--set", "gate.exact-mode-22.within=1%", "--no-report")
    assert status == 2
    assert "mode.frequency is in Hz, give the band in Hz as well" in err


def test_all_that_is_wrong_is_told_line_by_line_gates_by_their_ids(verify):
    status, out, err = verify(
        "run",
        "paper",
        *("--set", "beam.lenght=0.4"),
        *("--set", "gate.segment-order.withn=2"),
        *("--set", "gate.exact-mode-22.quantity=mode.freqency"),
        *("--set", "gate.fem-mode-22.arguments.cout=3"),
    )
    assert (status, out) == (2, "")
    assert err.splitlines() == [
        "verify: beam.lenght is not a known key: did you mean 'length'?",
        "verify: gate.segment-order.withn is not a known key: did you mean 'within'?",
        "verify: gate.exact-mode-22: quantity = 'mode.freqency' is not known: did you mean 'mode.frequency'?",
        "verify: gate.fem-mode-22: cout is not a known key: did you mean 'count'?",
    ]


def test_another_beam_has_a_report_of_its_own_and_fails_no_gate_of_the_scene(verify, tmp_path):
    status, out, _ = verify("run", "free-free-bar", "--set", "beam.length=0.4")
    assert status == 0
    assert "stated for another beam: --set beam.length" in words_of(out)
    (report,) = (tmp_path / "reports").glob("*.html")
    assert report.name == "free-free-bar--beam.length=0.4.html"
    page = report.read_text("utf-8")
    assert "No gate applies" in page
    assert 'title="stated for another beam: --set beam.length">n/a</td>' in page


def test_a_failed_gate_counts_beside_those_set_aside(verify):
    asked = ("--set", "drive.frequency_hz=4100", "--set", "gate.segment-order.expect=3.0", "--no-report")
    status, out, _ = verify("run", "paper", *asked)
    assert status == 1
    assert "1 of 24 gates failed, 1 not applicable" in words_of(out)


@pytest.mark.parametrize(
    "command", ["keys", "schema", "show", "init", "quantities", "run", "table", "choose", "plan", "catalogue"]
)
def test_help_has_an_example(verify, command):
    assert f"verify {command}" in words_of(verify(command, "--help")[1]).partition("Usage:")[2].partition("]")[2]
