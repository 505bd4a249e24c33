"""The tutorials' commands print what the pages say they print, to the last digit that stands there.

A box of `console` holds commands behind `$` and below each what it prints; `…` stands for anything. A line that ends with
a backslash goes on. Boxes with a caption are files that the commands find. A command without `$ echo $?` below it ends
with status 0, and what it says beside its output, of progress, is let be.
"""

import contextlib
import io
import os
import re
import runpy
import subprocess
import sys
from pathlib import Path

import msgspec
import pytest

from verify.cli import status_of

PAGES = sorted(Path(__file__).parents[2].joinpath("docs", "tutorials").glob("*.md"))
BOX = re.compile(r"^```(?P<head>[^\n]*)\n(?P<body>.*?)^```$", re.MULTILINE | re.DOTALL)


class Command(msgspec.Struct, frozen=True):
    """A command of a page and what is printed below it."""

    line: str
    printed: str


def boxes(text):
    """[(head, body), ...]."""
    return [(match["head"], match["body"]) for match in BOX.finditer(text)]


def files_of(text):
    """The files of a page by name."""
    captioned = [re.fullmatch(r":caption: (\S+)\n\n(.*)", body, re.DOTALL) for _, body in boxes(text)]
    return {match[1]: match[2] for match in captioned if match}


def commands_of(text):
    """All commands of a page in their order."""
    found = []
    for head, body in boxes(text):
        if head == "console":
            parts = re.split(r"^\$ ", body.replace("\\\n", ""), flags=re.MULTILINE)
            assert not parts[0].strip(), f"printed before any command: {parts[0]}"
            found += [Command(*part.split("\n", 1)) for part in parts[1:]]
    return found


def squeezed(text):
    """Blanks and rules of one length: a table is as wide as the times in it."""
    return re.sub("─+", "─", " ".join(text.split()))


def says(printed, output):
    """Whether what is printed on a page is what came out: all of it but what `…` stands for, blanks of any width."""
    pattern = ".*?".join(re.escape(squeezed(part)) for part in squeezed(printed).split("…"))
    return re.fullmatch(pattern.replace(r"\ .*?", r"\ ?.*?").replace(r".*?\ ", r".*?\ ?"), squeezed(output), re.DOTALL)


def verify(words, capsys):
    capsys.readouterr()
    status = status_of(words)
    out, err = capsys.readouterr()
    return status, out + err if status else out


def python(words, monkeypatch):
    said = io.StringIO()
    monkeypatch.setattr(sys, "argv", words)
    with contextlib.redirect_stdout(said):
        runpy.run_path(words[0], run_name="__main__")
    return 0, said.getvalue()


def gates(words):
    plain = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *words]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120, env=plain)
    return done.returncode, done.stdout + done.stderr


def ended(line, capsys, monkeypatch):
    """(exit status, all that is printed) of a command."""
    program, *words = line.split()
    if program == "verify":
        return verify(words, capsys)
    if program == "python":
        return python(words, monkeypatch)
    assert program == "pytest", f"no way to run {line!r}"
    return gates(words)


@pytest.mark.parametrize("page", PAGES[1:], ids=lambda page: page.stem)
def test_every_command_of_a_tutorial_prints_what_the_page_says(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    text = page.read_text("utf-8")
    for name, content in files_of(text).items():
        Path(name).write_text(content, "utf-8")
    commands, status = commands_of(text), 0
    for i, command in enumerate(commands):
        if command.line == "echo $?":
            assert int(command.printed) == status, commands[i - 1].line
            continue
        status, output = ended(command.line, capsys, monkeypatch)
        said_next = i + 1 < len(commands) and commands[i + 1].line == "echo $?"
        assert said_next or status == 0, f"{command.line}: exit status {status}\n{output}"
        assert says(command.printed, output), f"{command.line} printed\n{output}\nand not\n{command.printed}"


def test_there_are_three_tutorials_with_commands_whose_figures_are_read():
    assert [page.stem for page in PAGES] == ["index", "motor", "program", "teaching"]
    assert all(len(commands_of(page.read_text("utf-8"))) >= 8 for page in PAGES[1:])
    figures = [re.findall(r"\d\.\d+", c.printed) for page in PAGES[1:] for c in commands_of(page.read_text("utf-8"))]
    assert sum(map(bool, figures)) >= 30


@pytest.mark.parametrize(
    ("printed", "output", "right"),
    [
        ("a = 1.5 m\n", "a = 1.5 m\n", True),
        ("a = 1.5 m\n", "a = 1.6 m\n", False),
        ("a = 1.5… m\n", "a = 1.52 m\n", True),
        ("…\nb  2\n…\n", "a 1\nb 2\nc 3\n", True),
        ("…\nb 2\n", "a 1\nb 2\nc 3\n", False),
        ("b 2\n…\n", "b 2\n", True),
        ("", "a 1\n", False),
        (" N  time\n ───\n 7  …\n", " N    time \n ────── \n 7  1.25 ms \n", True),
    ],
)
def test_a_changed_digit_and_a_line_too_many_are_seen(printed, output, right):
    assert bool(says(printed, output)) is right
