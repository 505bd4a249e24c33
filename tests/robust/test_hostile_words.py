"""Titles, names, reasons and paths that would like to be more than words: in the page, in the terminal, in folders."""

import json
import re
from html.parser import HTMLParser

import pytest

from verify.cli import status_of

SCENE = """
name = "mine"
title = TITLE
description = TITLE
beam = { length = 0.61, width = 0.03, thickness = 0.002, youngs_modulus = 71e9, density = 2710.0 }
[[gate]]
id = "second"
quantity = "mode.frequency"
arguments = { model = "analytic", mode = 2 }
expect = 1.0
within = 1e-3
why = TITLE
[[claim]]
id = "said"
source = TITLE
quantity = "mode.frequency"
arguments = { model = "analytic", mode = 2 }
value = "positive"
read = "stated"
"""
WORDS = {
    "script": "</title></script><script>alert(1)</script><img src=x onerror=alert(2)>",
    "quotes": "\" onmouseover='alert(3)' x=`y` &lt; &#60;b>",
    "template": "{{ 7 * 7 }} {% raw %} ${x}",
    "controls": "\x1b[2J\x1b]0;owned\x07 \x08\x7f\x9b31m",
    "bidi": "abc \u202e txt.exe \u2066 \u200f",
    "markup": "[red]loud[/red] [link=http://x]y[/link] [/]",
}


class Page(HTMLParser):
    """What a browser would make of it: elements, and attributes that run something."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.running = [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.elements.append(tag)
        self.running += [name for name, value in attrs if name.startswith("on") or "javascript:" in (value or "")]


@pytest.fixture
def ran(tmp_path, monkeypatch, capsys):
    """Run a scene with these words everywhere: (what was printed, the page)."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")

    def run(words, *more):
        (tmp_path / "mine.toml").write_text(
            SCENE.replace("TITLE", json.dumps(words).replace("\x7f", "\\u007f")), "utf-8"
        )
        assert status_of(["run", "mine.toml", *more]) == 1
        out, err = capsys.readouterr()
        assert err == ""
        return out, (tmp_path / "reports" / "mine.html").read_text("utf-8")

    return run


@pytest.mark.parametrize("kind", WORDS)
def test_words_are_words_in_the_page_and_obeyed_by_no_terminal(ran, kind):
    out, page = ran(WORDS[kind])
    plain_out, plain = ran("Plain words")
    assert "Plain words" in plain
    found, usual = Page(page), Page(plain)
    assert found.elements == usual.elements
    assert found.running == usual.running == []
    assert all(c.isprintable() or c == "\n" for c in out)
    assert len(out.splitlines()) == len(plain_out.splitlines())
    if kind == "markup":
        assert WORDS[kind] in out
    if kind == "template":
        assert "49" not in re.sub(r"[\d.]+ (µ|m)?s", "", out.splitlines()[0])
        assert "{{ 7 * 7 }}" in page


@pytest.mark.parametrize(
    "name", ["../out", "/out", "a/b", "..", ".hidden", "a\\b", "con\x00", "x" * 121, "", "\u202ex"]
)
def test_no_name_leads_a_report_out_of_its_folder(tmp_path, monkeypatch, capsys, name):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text(SCENE.replace("TITLE", '"t"').replace('"mine"', json.dumps(name)), "utf-8")
    assert status_of(["run", "mine.toml", "--reports", "in"]) == 2
    assert capsys.readouterr().err.startswith("verify: name = ")
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["mine.toml"]


@pytest.mark.parametrize(
    "change",
    [
        "beam.loss_factor=1e-3",
        'drive={frequency_hz=10.0, kind="force", force=[{position=0.1}]}',
        "beam.spring=[{position=0.3, stiffness=1.0e1}]",
    ],
)
def test_what_is_set_names_the_report_and_the_folder_of_its_runs(tmp_path, monkeypatch, change):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text(SCENE.replace("TITLE", '"t"').partition("[[claim]]")[0])
    status_of(["run", "mine.toml", "--reports", "in", "--set", change])
    (page,) = (tmp_path / "in").glob("*.html")
    assert {path.name for path in (tmp_path / "in").iterdir()} == {page.name, page.stem}
    assert re.fullmatch(r"mine--[A-Za-z0-9.=_+-]+\.html", page.name)


@pytest.mark.parametrize(
    "words",
    [
        ("run", "a\x1b[2Jb"),
        ("no\x1b[2Jsuch",),
        ("plan", "paper", "--no\x1bsuch"),
        ("init", "in\x1b[2J.toml"),
        ("run", "paper", "--set", "title=\udcff"),
    ],
)
def test_what_is_typed_comes_back_escaped(tmp_path, monkeypatch, capsys, words):
    monkeypatch.chdir(tmp_path)
    status = status_of(list(words))
    out, err = capsys.readouterr()
    assert status == (0 if words[0] == "init" else 2)
    assert all(c.isprintable() or c == "\n" for c in out + err)
    assert "\\x1b" in out + err or "\\udcff" in err
