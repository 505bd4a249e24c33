"""Commands on pages exist; those of the tutorials print what the page shows; Python on pages runs.

A `console` box holds commands after `$`, each followed by its output; `…` stands for anything. Boxes with a caption are
files. A command without `$ echo $?` below it ends with status 0.
"""

import re
import runpy
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from verify.cli import cli, status_of

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
TUTORIALS = [
    ROOT / "docs" / "tutorials" / f"{name}.md" for name in ("motor", "program", "teaching", "from-a-track-to-a-chain")
]
GUIDES = [
    ROOT / "docs" / f"{name}.md"
    for name in ("engines", "actuators", "control", "compare", "cases", "continuous-integration")
]
BOX = re.compile(r"^```(\S*)[^\n]*\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def boxes(page, *languages):
    return [body for language, body in BOX.findall(page.read_text("utf-8")) if language in languages]


@pytest.mark.parametrize("page", [*PAGES, *TUTORIALS], ids=lambda page: page.stem)
def test_commands_on_pages_exist_with_their_options(page):
    text = "\n".join(boxes(page, "sh", "console", "")).replace("\\\n", "")
    text += "\n" + "\n".join(re.findall(r"`(verify [a-z][^`]*)`", page.read_text("utf-8").replace("\n", " ")))
    for line in re.findall(r"^(?:\$ |.*&& )?verify ([a-z][^#&>|\n]*)", text, re.MULTILINE):
        name, *words = shlex.split(line)
        command = cli.get_command(None, name)
        assert command is not None, line
        options = {option for one in command.params for option in one.opts}
        for sub in getattr(command, "commands", {}).values():
            options |= {option for one in sub.params for option in one.opts}
        assert {word for word in words if word.startswith("--")} <= options | {"--help"}, line


def test_tour_shows_every_command():
    text = "\n".join(boxes(ROOT / "docs" / "tour.md", "sh"))
    assert [name for name in cli.list_commands(None) if f"verify {name}" not in text] == []


@pytest.mark.parametrize("name", ["tour", "actuators"])
def test_python_of_a_page_runs(name):
    known = {}
    for body in boxes(ROOT / "docs" / f"{name}.md", "python"):
        exec(body.replace('run_scene("paper")', 'run_scene("driving-layer")'), known)
    assert known["beam"].length == 0.5


def squeezed(text):
    return re.sub(r"\s+", " ", text).strip()


def shows(printed, output):
    """Whether a page shows an output: equal but for white space and what `…` replaces."""
    parts = [re.escape(squeezed(part)) for part in printed.split("…")]
    return re.fullmatch(r"\s*.*?\s*".join(parts), squeezed(output), re.DOTALL) is not None


def ran(line, capsys, monkeypatch):
    """(exit status, output) of a command, in this process."""
    program, *words = shlex.split(line)
    if program == "python":
        monkeypatch.setattr(sys, "argv", words)
        runpy.run_path(words[0], run_name="__main__")
        return 0, capsys.readouterr().out
    if program == "pytest":
        monkeypatch.delenv("PYTEST_ADDOPTS", raising=False)  # options of the run around this one
        done = subprocess.run([sys.executable, "-m", "pytest", *words], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout
    capsys.readouterr()
    status = status_of(words)
    out, err = capsys.readouterr()
    return status, err if status == 2 else out


@pytest.mark.parametrize("page", [ROOT / "README.md", *GUIDES, *TUTORIALS], ids=lambda page: page.stem)
def test_commands_of_a_tutorial_print_what_it_shows(page, tmp_path, monkeypatch, capsys):
    if page.stem == "engines":
        pytest.importorskip("mujoco")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tests").symlink_to(ROOT / "tests")  # pages name files of the repository from its top folder
    text, status = page.read_text("utf-8"), 0
    for name in re.findall(r"\{download\}`([^`]+)`", text):
        Path(name).write_bytes((page.parent / name).read_bytes())
    for name, body in re.findall(r"^:caption: (\S+)\n\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        Path(name).write_text(body, "utf-8")
    parts = [re.split(r"^\$ ", body.replace("\\\n", ""), flags=re.MULTILINE)[1:] for body in boxes(page, "console")]
    commands = [part.split("\n", 1) for box in parts for part in box]
    for (line, printed), after in zip(commands, [*commands[1:], ["", ""]], strict=True):
        if line == "echo $?":
            assert int(printed) == status
        else:
            status, output = ran(line, capsys, monkeypatch)
            assert status == 0 or after[0] == "echo $?", output
            assert shows(printed, output), f"{line}\n{output}"
