"""What pages tell their readers to type exists, and lines of Python on them run."""

import json
import re
from pathlib import Path

import pytest

from verify.cli import COMMANDS, status_of

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
PAGES += sorted((ROOT / "docs" / "tutorials").glob("*.md"))
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def blocks(page, *words):
    return [body for word, body in BLOCK.findall(page.read_text("utf-8")) if word in words]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_command_named_in_a_box_is_one(page):
    lines = "\n".join(blocks(page, "sh", "console", ""))
    named = set(re.findall(r"^(?:\$ |pip install .*&& )?verify ([a-z-]+)", lines, re.MULTILINE))
    assert named <= set(COMMANDS)


def test_pages_name_most_commands():
    text = "\n".join(page.read_text("utf-8") for page in PAGES)
    assert [name for name in COMMANDS if f"verify {name}" not in text] == []


def test_the_bench_of_the_tour_compares_the_mode_of_the_first_page(capsys):
    """Segments and elements at mode 22, where both fall at their order over the sizes that the line gives."""
    text = (ROOT / "docs" / "tour.md").read_text("utf-8")
    (line,) = re.findall(r"^verify (bench paper .*?) +#", text, re.MULTILINE)
    assert status_of([*line.split(), "--modes", "22", "--json"]) == 0
    sentences = json.loads(capsys.readouterr().out)["sentences"]
    (told,) = [one for one in sentences if one["methods"] == ["segments", "Hermite elements"]]
    assert told["earned"], told["text"]


@pytest.mark.parametrize("page", [ROOT / "README.md", ROOT / "docs" / "tour.md"], ids=lambda page: page.stem)
def test_the_lines_of_python_on_a_page_run(page):
    known = {}
    found = blocks(page, "python")
    assert found
    for body in found:
        exec(compile(body, page.name, "exec"), known)
    assert known["beam"].length == 0.5
