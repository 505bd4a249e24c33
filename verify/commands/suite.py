"""Several scenes run side by side, and one page over all."""

from collections.abc import Callable, Sequence
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import click
import msgspec

from verify.commands.shared import GATE_FAILED, command_line, load, print_json, progress
from verify.errors import InputError, one_line, raise_all

if TYPE_CHECKING:
    from verify.apart import Died
    from verify.report.suite import Card, Refused, Suite
    from verify.scenes.scene import Scene

NOT_RUN = 2


class Asked(msgspec.Struct, frozen=True, kw_only=True):
    """One scene that is to be run, and where what it finds goes."""

    given: str
    scene: "Scene"
    name: str
    overrides: tuple[str, ...]
    folder: Path | None
    most: int
    plain: bool
    """Whether all its figures are wanted."""
    steps: int
    """How often it tells of its progress."""
    at_once: int
    """Scenes that run side by side."""


class Ran(msgspec.Struct, frozen=True, kw_only=True):
    """What is left of a run."""

    card: "Card | Refused"
    plain: dict[str, Any]
    told: tuple[str, ...] = ()
    """Of kernels that no folder keeps."""


def run_several(
    given: tuple[str, ...], overrides: tuple[str, ...], folder: Path | None, most: int, as_json: bool
) -> None:
    """Run the scenes that are given, or all that are packaged; exit 1 when a gate fails, 2 when a scene cannot run.

    The one with most to do is begun first.
    """
    from verify.apart import each_apart
    from verify.cores import jobs
    from verify.files import writable_folder
    from verify.models.compiling import hearers
    from verify.report.suite import suite_of
    from verify.scenes.problems import MOST
    from verify.scenes.scene import packaged_scenes

    began, at_once = perf_counter(), jobs()
    names = given or packaged_scenes()
    found = _loaded(names, overrides, folder, most, as_json)
    if not any(isinstance(one, Asked) for one in found.values()):
        raise_all([sentence for one in found.values() if isinstance(one, Ran) for sentence in _sentences(one)], MOST)
    if folder is not None:
        writable_folder(folder, "reports")
    asked = sorted((one for one in found.values() if isinstance(one, Asked)), key=lambda one: -one.steps)
    _bring_in(draws=folder is not None)
    with progress(sum(one.steps for one in asked), quiet=as_json) as step:
        hears = tuple(hearers)
        ended = each_apart(_run, asked, lambda index, said: _tell(step, hears, asked[index].name, said))
    done = {one.given: _ended(one, end) for one, end in zip(asked, ended, strict=True)}
    runs = [done.get(name) or found[name] for name in found]
    every = tuple(run for run in runs if isinstance(run, Ran))
    scenes = tuple(run.card for run in every)
    suite = suite_of(scenes, perf_counter() - began, command_line("run", given, overrides), min(at_once, len(asked)))
    _show(suite, every, folder, as_json)
    if not suite.passed:
        raise SystemExit(NOT_RUN if suite.refused else GATE_FAILED)


def _show(suite: "Suite", every: Sequence[Ran], folder: Path | None, as_json: bool) -> None:
    """Its page, what the runs have to say, and its table or plain data."""
    from verify.models.compiling import told

    page = None
    if folder is not None:
        from verify.report.suite import write_suite

        page = write_suite(suite, folder)
    told_once = dict.fromkeys(sentence for run in every for sentence in (*_sentences(run), *run.told))
    for sentence in told_once:
        if sentence not in told():  # which the command line says at its end
            click.echo(f"verify: {sentence}", err=True)
    if as_json:
        from verify.report.suite import as_plain

        print_json(as_plain(suite, [run.plain for run in every], page))
    else:
        from verify.report.terminal_suite import print_suite

        print_suite(suite, page)


def _sentences(run: Ran) -> tuple[str, ...]:
    """Why a scene could not run."""
    from verify.report.suite import Refused

    card = run.card
    return (
        tuple(one_line(f"{card.name}: {sentence}") for sentence in card.sentences) if isinstance(card, Refused) else ()
    )


class Said(msgspec.Struct, frozen=True):
    """What a scene says on its way: the step that it takes, or that it compiles, which is none."""

    words: str
    compiles: bool = False


def _tell(step: Callable[[str], None], hears: tuple[Callable[[str], None], ...], name: str, said: Said) -> None:
    """Hand it on."""
    if not said.compiles:
        step(f"{name}: {said.words}")
        return
    for hear in hears:
        hear(said.words)


def _loaded(
    names: tuple[str, ...], overrides: tuple[str, ...], folder: Path | None, most: int, plain: bool
) -> "dict[str, Asked | Ran]":
    """Every scene once, in order: loaded, or why it cannot be. Two whose reports had one name are not both run."""
    from verify.cores import jobs
    from verify.run.applies import TAKEN, check_free, report_name, that_change
    from verify.run.runner import n_steps

    taken = dict(TAKEN)
    found: dict[str, Asked | Ran] = {}
    for given in dict.fromkeys(names):
        try:
            scene = load(given, overrides)
            name = report_name(scene, that_change(given, overrides))
            check_free(name, taken)
            taken[name.casefold()] = f"that of {given}"
            if folder is not None and most:
                from verify.report.kept import folder_for

                folder_for(folder, name)
            found[given] = Asked(
                given=given,
                scene=scene,
                name=name,
                overrides=overrides,
                folder=folder,
                most=most,
                plain=plain,
                steps=n_steps(scene),
                at_once=min(jobs(), len(names)),
            )
        except InputError as error:
            found[given] = _refused(given, error.sentences)
    return found


def _refused(name: str, sentences: tuple[str, ...]) -> Ran:
    from verify.report.suite import Refused

    card = Refused(name=one_line(name), sentences=sentences)
    return Ran(card=card, plain={"scene": card.name, "passed": False, "error": list(sentences)})


def _bring_in(*, draws: bool) -> None:
    """Import once what nearly every scene uses, so that processes begin with it."""
    import verify.elements.linear
    import verify.judge.workbench
    import verify.report.document
    import verify.segments.linear  # noqa: F401

    if draws:
        from verify.report.drawing import drawn
        from verify.report.html import templates
        from verify.studies.chart import Axis, Chart, Line

        drawn(Chart(id="", title="", caption="", x=Axis(""), y=Axis(""), lines=(_point(Line),)))
        templates().get_template("page.html.j2")


def _point(line: Any) -> Any:
    return line(name="", x=(0.0, 1.0), y=(0.0, 1.0), colour="#000000")


def _run(asked: Asked, say: Callable[[Said], None]) -> Ran:
    """One scene, its report written. Raises nothing but what ends a process."""
    from verify.models.compiling import hearers, told

    before = tuple(hearers)
    hearers[:] = [lambda words: say(Said(words and f"{asked.name}: {words}", compiles=True))]  # the bar is the parent's
    try:
        ran = _ran(asked, lambda words: say(Said(words)))
    except InputError as error:
        return _refused(asked.name, error.sentences)
    except BrokenPipeError:
        raise
    except Exception as error:
        why = f"the suite itself fails on it ({type(error).__name__}: {error}), `verify run {asked.given}` shows where"
        return _refused(asked.name, (one_line(why),))
    finally:
        hearers[:] = before
    return msgspec.structs.replace(ran, told=told())


def _ran(asked: Asked, say: Callable[[str], None]) -> Ran:
    from verify.report.kept import keep
    from verify.report.plain import run_as_plain
    from verify.report.suite import card_of
    from verify.run.applies import that_change
    from verify.run.runner import run_scene

    result = run_scene(asked.scene, say, that_change(asked.given, asked.overrides))
    written = None
    if asked.folder is not None:
        line = command_line("run", (asked.given,), asked.overrides)
        written = keep(result, asked.folder, asked.name, line, asked.most, at_once=asked.at_once)
    card = card_of(result, asked.name, written, asked.folder or Path())
    plain = run_as_plain(result, written.latest if written else None) if asked.plain else {}
    return Ran(card=card, plain=plain)


def _ended(asked: Asked, end: "Ran | Died") -> Ran:
    """A run, or that its process is gone."""
    if isinstance(end, Ran):
        return end
    how = f"signal {-end.status}" if end.status < 0 else f"status {end.status}"
    why = f"its process ended before it was done ({how}), for want of memory perhaps: run it alone, or VERIFY_JOBS=1"
    return _refused(asked.name, (why,))
