"""What commands share: options of the same name, a scene loaded, JSON printed, a bar of progress."""

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.errors import InputError, NoTomlError, raise_all, shown

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

GATE_FAILED = 1
"""The exit status where one did."""
PERCENT = 100
DEFAULT = "paper"
"""The scene of a command that is told none."""

overridden = click.option(
    "--set",
    "overrides",
    multiple=True,
    metavar="KEY=VALUE",
    help="Override a value of the scene: beam.length=0.4, gate.ID.within=1%.",
)
json_alone = click.option("--json", "as_json", is_flag=True, help="Print JSON and nothing else.")
scene_name = click.argument("scene")


def load(scene: str, overrides: tuple[str, ...]) -> "Scene":
    """A scene with its overrides. Raises InputError; where the scene is wrong, for its gates' figures as well."""
    from verify.scenes.problems import MOST
    from verify.scenes.scene import load_scene, scene_type, tables_of

    try:
        loaded = load_scene(scene, overrides)
    except InputError as error:
        from verify.run.asks import wrong_figures

        data = tables_of(scene, overrides)
        scene_type(data)  # raises again what is no matter of the scene's own tables
        raise_all([*error.sentences, *wrong_figures(data)], MOST)
        raise
    if any(text.rstrip().endswith("%") for text in overrides):
        from verify.run.asks import check_per_cents

        check_per_cents(loaded, overrides)
    return loaded


def page_at(target: str) -> Path:
    """Where a page is written. Raises InputError for a name of anything else: the run that it tells would be lost."""
    if not target.lower().endswith((".html", ".htm")):
        raise InputError(f"--to = {shown(target)} is no name of a page: let it end in .html")
    return Path(target)


def is_scene(word: str) -> bool:
    """Whether a word can be nothing but a scene: a packaged one's name, or that of a TOML file."""
    from verify.scenes.scene import packaged_scenes

    return word.endswith(".toml") or word in packaged_scenes()


def load_first(words: Sequence[str], option: str | None, named: str, overrides: tuple[str, ...], usage: str) -> "Scene":
    """The scene `named`, which is the first of `words` unless that is a file that follows it in `usage`.

    Raises InputError as `load`, and where the words stand the other way round or the first is no TOML file.
    """
    misplaced = f"{named!r} stands where SCENE comes first, as in `{usage}`"
    if not words or option is not None or named != words[0] or is_scene(named):
        return load(named, overrides)
    if any(is_scene(word) for word in words[1:]):
        raise InputError(f"{misplaced}: turn the words round")
    try:
        return load(named, overrides)
    except NoTomlError as error:
        raise InputError(f"{misplaced}: {error}") from None


def scene_first(
    words: Sequence[str], option: str | None, after: int, default: str | None = DEFAULT
) -> tuple[str, Sequence[str]]:
    """(the scene, the words after it) of a command line's words, `after` of which at most follow a scene.

    The scene is the first where there is one more, or where nothing else says it; else what `option`, or the default,
    says. Raises InputError where both do, click's UsageError where there are more words or none says it.
    """
    if len(words) > after + 1:
        raise click.UsageError(f"Got unexpected extra argument ({words[after + 1]})")
    leads = len(words) > after or (option is None and default is None)
    if not leads:
        return option or default or "", words
    if not words:
        raise click.UsageError("Missing argument 'SCENE'.")
    if option is not None:
        raise InputError(f"the scene is given twice, as {words[0]!r} and as --scene {option!r}: give one of them")
    return words[0], words[1:]


def print_json(data: Any) -> None:
    """Plain data on standard output, None for numbers that JSON cannot hold."""
    import json

    from verify.report.plain import finite

    click.echo(json.dumps(finite(data), indent=2, allow_nan=False))


def whole_number(field: str, text: str | None) -> int | None:
    """A whole number from 1 as typed; None where nothing is. Raises InputError."""
    if text is None:
        return None
    from verify.scenes.toml import literal

    value = literal(text, field)
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        raise InputError(f"{field} = {text!r}: give a whole number from 1")
    return value


def command_line(
    command: str, scenes: tuple[str, ...], overrides: tuple[str, ...], options: tuple[str, ...] = ()
) -> str:
    """The line that does the same again."""
    return as_line(["verify", command, *scenes, *(word for text in overrides for word in ("--set", text)), *options])


def as_line(words: list[str]) -> str:
    """Words as a line for a shell; bytes of a path that are no UTF-8 as they are written in a string."""
    from shlex import join

    return join(words).encode(errors="backslashreplace").decode()


def in_percent(step: Callable[[str], None]) -> Callable[[float], None]:
    """Parts of a whole, told to a bar of a hundred steps."""
    shown = 0

    def tell(part: float) -> None:
        nonlocal shown
        while shown < int(PERCENT * part):
            shown += 1
            step("motion in time")

    return tell


@contextmanager
def progress(n_steps: int, *, quiet: bool) -> Iterator[Callable[[str], None]]:
    """A bar on the error stream where somebody looks at it; silence elsewhere."""
    if quiet or not sys.stderr.isatty():
        yield lambda step: None
        return
    from verify.report.terminal import progress_bar

    with progress_bar(n_steps) as step:
        yield step


RULES = {
    "wall": "How segments are held at a clamped end: gregory, half (the literature's 2EI/l), welded, third-order, "
    "five-joint.",
    "joints": "The spring between two links: series, printed (Eq. (1) as published), tensioned.",
    "grading": "Length of a section's last part over its first.",
    "theory": "Of the beam: euler-bernoulli, rayleigh, timoshenko.",
    "attachment": "How segments feel point masses and springs: reciprocal, lever.",
}
"""Options that set models up, each one word or several with commas."""


def ruled(command: Callable[..., None]) -> Callable[..., None]:
    """The options of `RULES`, handed on as one dict `rules` of those that were given."""

    @wraps(command)
    def called(**options: Any) -> None:
        given = {name: options.pop(name) for name in RULES}
        command(**options, rules={name: text for name, text in given.items() if text is not None})

    made: Callable[..., None] = called
    for name, words in reversed(RULES.items()):
        made = click.option(f"--{name}", metavar="LIST", help=words)(made)
    return made
