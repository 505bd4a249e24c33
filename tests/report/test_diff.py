"""What changed between two runs: gates first, the status that of gates that were held and fail."""

import json
from itertools import count

import pytest
from strip import DRAWN, STRIP

from verify import run_scene
from verify.cli import status_of
from verify.report.document import document_of
from verify.report.kept import as_text
from verify.scenes.scene import load_scene

MORE = """
[[gate]]
id = "third"
quantity = "mode.frequency"
arguments = { model = "analytic", mode = 3 }
expect = 112.2759
within = 1e-3
why = "Nine times the first."
"""


@pytest.fixture
def kept(tmp_path, monkeypatch):
    """Keep a run of the strip as it is, or with overrides: the folder of that run."""
    (tmp_path / "strip.toml").write_text(DRAWN)
    (tmp_path / "more.toml").write_text(DRAWN + MORE)
    monkeypatch.chdir(tmp_path)

    seconds = count(10)

    def run(*overrides, scene="strip.toml", folder="reports", name="strip"):
        result = run_scene(load_scene(scene, overrides), overrides=overrides)
        made = tmp_path / folder / name / f"2001-02-03_04-05-{next(seconds)}"
        made.mkdir(parents=True)
        text = as_text(document_of(result, "verify run"), name, {})
        (made / "run.json").write_text(text, encoding="utf-8")
        return made

    return run


def told(capsys, *words):
    """(status, output)."""
    capsys.readouterr()
    status = status_of(["diff", *map(str, words)])
    out, err = capsys.readouterr()
    assert not err
    return status, out


def test_a_run_that_is_done_again_is_the_same_to_the_last_digit(kept, capsys):
    status, out = told(capsys, kept(), kept())
    assert status == 0
    assert out == "strip: 1 gate the same to the last digit\nNo gate that was held fails now\n"


def test_a_gate_that_fails_now_is_told_first_and_is_the_status(kept, capsys):
    before = kept(scene="more.toml")
    after = kept("gate.third.expect=112.3", scene="more.toml")
    status, out = told(capsys, before, after)
    assert status == 1
    assert out.startswith("strip: 1 gate held before and fails now\n")
    row = next(line for line in out.splitlines() if line.strip().startswith("third"))
    assert "pass to FAIL" in row
    assert "second" not in out
    status, out = told(capsys, after, before)
    assert status == 0
    assert "1 verdict changed, none from pass to FAIL" in out


CLAIMED = """
[[claim]]
id = "c1"
source = "a table, row 2"
quantity = "mode.frequency"
arguments = { model = "analytic", mode = 2 }
value = 49.9
read = "stated"
tolerance = 0.3
[[claim]]
id = "c2"
source = "a table, row 3"
quantity = "mode.frequency"
arguments = { model = "analytic", mode = 3 }
value = 113.0
read = "stated"
tolerance = 0.2
"""


def test_a_claim_that_held_and_fails_now_is_told_and_so_is_one_that_holds_again(kept, capsys, tmp_path):
    """They are shown and not judged: the status is that of gates. One with the verdict that it had is not told."""
    (tmp_path / "claimed.toml").write_text(DRAWN + CLAIMED)
    before = kept(scene="claimed.toml")
    stiffer = "beam.youngs_modulus=73e9"
    after = kept(stiffer, "gate.second.expect=50.59834", scene="claimed.toml")
    status, out = told(capsys, before, after)
    assert status == 0
    assert "holds c1," in out
    assert "fails c1," in out
    assert " c2," not in out
    status, out = told(capsys, before, after, "--json")
    claims = [one for one in json.loads(out)["scenes"][0]["said"] if one["what"] == "claims"]
    assert [one["before"][:8] + one["after"][:8] for one in claims] == ["holds c1fails c1"]
    assert "found +49.9 Hz" in claims[0]["before"]
    assert "found +50.598 Hz" in claims[0]["after"]
    _, out = told(capsys, after, before, "--json")
    (back,) = [one for one in json.loads(out)["scenes"][0]["said"] if one["what"] == "claims"]
    assert (back["before"][:8], back["after"][:8]) == ("fails c1", "holds c1")
    _, out = told(capsys, before, kept(scene="claimed.toml"), "--json")
    assert not json.loads(out)["scenes"][0]["said"]
    _, out = told(capsys, kept(), before, "--json")
    new = {one["after"][:8]: one["before"] for one in json.loads(out)["scenes"][0]["said"] if one["what"] == "claims"}
    assert new == {"holds c1": None, "fails c2": None}


def test_figures_in_which_verdicts_do_not_differ_are_told_with_their_difference(kept, capsys):
    status, out = told(capsys, kept(), kept("beam.length=0.610001", "gate.second.expect=49.90025"), "--json")
    (scene,) = json.loads(out)["scenes"]
    assert status == 0
    (gate,) = scene["gates"]
    assert gate["after"]["measured"] / gate["before"]["measured"] - 1.0 == pytest.approx(-2e-6 / 0.61, rel=1e-4)
    assert scene["inputs"] == [{"what": "beam.length", "before": "0.61", "after": "0.610001"}]
    assert scene["versions"] == scene["said"] == []


def test_gates_that_came_and_went_are_told_and_break_nothing(kept, capsys):
    less, more = kept(), kept(scene="more.toml")
    for before, after, words in ((less, more, "not there to pass"), (more, less, "pass to not there")):
        status, out = told(capsys, before, after, "--json")
        assert status == 0
        assert [gate["id"] for gate in json.loads(out)["scenes"][0]["gates"]] == ["third"]
        assert words in " ".join(told(capsys, before, after)[1].split())


def test_a_relative_difference_stands_behind_what_is_measured(kept):
    from verify.report.diff import differences
    from verify.report.kept import runs_at

    before, after = (runs_at(path, "A") for path in (kept(), kept("beam.length=0.305", "gate.second.expect=199.6")))
    (gate,) = differences(before, after, ("a", "b")).scenes[0].gates
    assert gate.measured.endswith("(+300 %)")


def test_versions_and_inputs_are_compared_by_their_names(kept, tmp_path, capsys):
    before, after = kept(), kept("spectrum.count=11")
    data = json.loads((before / "run.json").read_text())
    data["document"]["environment"] |= {"numpy": "0.1", "abacus": "3"}
    (before / "run.json").write_text(json.dumps(data))
    (scene,) = json.loads(told(capsys, before, after, "--json")[1])["scenes"]
    import numpy

    versions = {one["what"]: (one["before"], one["after"]) for one in scene["versions"]}
    assert versions == {"numpy": ("0.1", numpy.__version__), "abacus": ("3", None)}
    assert scene["inputs"] == [{"what": "spectrum.count", "before": "9", "after": "11"}]
    assert [one["what"] for one in scene["said"]] == ["answer", "spectrum"]
    assert ("9 segments" in scene["said"][0]["before"], "11 segments" in scene["said"][0]["after"]) == (True, True)


def test_of_folders_the_newest_runs_of_every_name_are_compared(kept, tmp_path, capsys):
    kept("gate.second.expect=50")
    kept()
    kept(name="gone")
    kept("gate.second.expect=50", folder="other")
    kept(folder="other", name="come")
    status, out = told(capsys, "reports", "other", "--json")
    data = json.loads(out)
    assert (status, data["broken"], data["only_before"], data["only_after"]) == (1, 1, ["gone"], ["come"])
    assert [one["name"] for one in data["scenes"]] == ["strip"]
    assert told(capsys, "reports/strip", "other/strip")[0] == 1
    assert told(capsys, "other", "other") == (
        0,
        "come: 1 gate the same to the last digit\nstrip: 1 gate the same to the last digit\n"
        "No gate that was held fails now\n",
    )


def test_the_page_of_a_difference_has_its_verdict_and_links_to_what_broke(kept, tmp_path, capsys):
    status, _ = told(capsys, kept(), kept("gate.second.expect=50"), "--to", tmp_path / "d.html")
    page = (tmp_path / "d.html").read_text("utf-8").replace("<wbr>", "")
    assert status == 1
    assert "<strong>1 gate held before and fails now</strong>" in page
    assert '<a href="#strip-gate-second">' in page
    assert 'id="strip-gate-second"' in page
    assert "49.90041 ± 0.001 to 50 ± 0.001" in page.replace("50.0", "50")
    assert page.rstrip().endswith("</html>")


ASKED = """
[[gate]]
id = "too-high"
quantity = "mode.frequency"
arguments = { model = "segment", mode = 19, count = 19 }
expect = 66.8
within = 1.0
why = "More modes than a chain has."
"""


def test_what_a_gate_asks_is_an_input_though_its_figure_is_the_same_to_the_last_digit(kept, tmp_path, capsys):
    """No mode 19 of 19 segments and no mode 31 of 23: both gates fail without a figure; a wall at no end moves none."""
    (tmp_path / "before.toml").write_text(STRIP + ASKED)
    asked = ASKED.replace("mode = 19, count = 19", 'mode = 31, count = 23, wall = "half"')
    (tmp_path / "after.toml").write_text(STRIP.replace("2 pi", "two pi") + asked)
    before, after = kept(scene="before.toml"), kept(scene="after.toml")
    _, out = told(capsys, before, after)
    assert out.startswith("strip: 2 gates the same to the last digit, not all else\n")
    (scene,) = json.loads(told(capsys, before, after, "--json")[1])["scenes"]
    changed = {one["what"]: (one["before"], one["after"]) for one in scene["inputs"]}
    asks = "gate.too-high.arguments"
    assert changed == {
        f"{asks}.mode": ("19", "31"),
        f"{asks}.count": ("19", "23"),
        f"{asks}.wall": (None, "half"),
        "gate.second.why": ("2 pi sqrt(E h^2 / 12 rho) / L^2.", "two pi sqrt(E h^2 / 12 rho) / L^2."),
    }


def test_gates_that_were_held_and_are_judged_no_more_are_counted_beside_the_verdict(kept, tmp_path, capsys):
    """One is gone, one does not apply: of neither is known whether it would be held."""
    (tmp_path / "more.toml").write_text(DRAWN + MORE)
    before, aside = kept(scene="more.toml"), kept("beam.length=0.4", scene="more.toml")
    last = "No gate that was held fails now, {} judged no more\n"
    assert told(capsys, before, kept())[1].endswith(last.format("1 is"))
    assert told(capsys, before, aside)[1].endswith(last.format("2 are"))
    assert told(capsys, aside, before)[1].endswith("No gate that was held fails now\n")


def test_runs_of_which_none_is_in_both_are_refused(kept, capsys):
    """Nothing would be compared, and nothing be said to fail."""
    for name, folder in (("bar", "reports"), ("strip", "reports"), ("rod", "other"), ("tube", "other")):
        kept(folder=folder, name=name)
    status = status_of(["diff", "reports", "other"])
    assert (status, *capsys.readouterr()) == (
        2,
        "",
        "verify: A = 'reports' holds bar, strip and B = 'other' holds rod, tube, nothing of one name: give two runs of "
        "the same\n",
    )


def test_of_two_folders_of_one_name_the_newest_run_is_compared(kept, tmp_path, capsys):
    """Whatever the folders are called, and whatever lies beside a run."""
    older = kept(folder="first")
    newest = kept("gate.second.expect=50", folder="second")
    (newest / "notes.txt").write_text("mine")
    older.parent.rename(tmp_path / "second" / "zzz")
    kept(folder="before")
    assert told(capsys, "before", "second")[0] == 1
    assert told(capsys, "before", newest.parent)[0] == 1


def test_gates_that_no_run_judged_are_not_called_the_same(kept, capsys):
    """Of four gates on another beam one is judged: it alone is the same to the last digit."""
    before, after = (kept("beam.supports=['clamped', 'free']") for _ in range(2))
    status, out = told(capsys, before, after)
    assert status == 0
    assert "0 gates the same to the last digit" in " ".join(out.split())
    assert "judged in neither" in " ".join(out.split())
