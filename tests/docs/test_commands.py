"""What pages tell their readers to type exists, and lines of Python on them run."""

import re
from pathlib import Path

import pytest

from verify.cli import COMMANDS

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


@pytest.mark.parametrize("page", [ROOT / "README.md", ROOT / "docs" / "tour.md"], ids=lambda page: page.stem)
def test_the_lines_of_python_on_a_page_run(page):
    known = {}
    found = blocks(page, "python")
    assert found
    for body in found:
        exec(compile(body, page.name, "exec"), known)
    assert known["beam"].length == 0.5
