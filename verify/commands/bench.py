"""Run time against error of every method that a scene gives something to do."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared import command_line, json_alone, load, overridden, progress, scene_name

if TYPE_CHECKING:
    from verify.bench.found import BenchFound


@click.command()
@scene_name
@overridden
@click.option("--sets", metavar="LIST", help="Of modes, harmonic, transient, slider, chain. Default: what SCENE asks.")
@click.option("--counts", metavar="LIST", help="Segments and elements, for instance 24,49,98. Default: the scene's.")
@click.option("--modes", metavar="LIST", help="Which modes, for instance 1,5,22. Default: the scene's.")
@click.option("--seconds", metavar="CAP", help="Of work by its estimate: what does not fit is left out. Default: 20.")
@click.option("--cold", is_flag=True, help="Time compiling too, with nothing kept on disk.")
@click.option("--push", is_flag=True, help="Push other engines until they break, and say what they did.")
@json_alone
@click.option("--csv", "layout", flag_value="csv", help="Print comma-separated values.")
@click.option("--markdown", "layout", flag_value="markdown", help="Print a Markdown table.")
@click.option(
    "--against",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="An earlier --json: ratios between methods are compared, and what moved is said.",
)
@click.option(
    "--keep",
    type=click.Path(path_type=Path, file_okay=False),
    metavar="FOLDER",
    help="Write a dated Markdown page of this scene there.",
)
def bench(
    scene: str,
    overrides: tuple[str, ...],
    sets: str | None,
    counts: str | None,
    modes: str | None,
    seconds: str | None,
    cold: bool,
    push: bool,
    as_json: bool,
    layout: str | None,
    against: Path | None,
    keep: Path | None,
) -> None:
    """Run time against error: every method, its reference, and one sentence for each comparison.

    Modes by every rule of segments, elements, stock scikit-fem; harmonic fields; motions in time; the slider; the
    nonlinear chain; other engines where they are installed.

    Example: `verify bench paper --sets modes --counts 25-100:25`
    """
    from verify.bench.asking import asked_of, job_of

    asked = load(scene, overrides)
    typed = {"sets": sets, "counts": counts, "modes": modes, "seconds": seconds}
    given = {name: text for name, text in typed.items() if text is not None}
    request = asked_of(asked, given, cold=cold, push=push)
    earlier = _earlier(against)
    if keep is not None:
        from verify.files import writable_folder

        writable_folder(keep, "--keep")
    n_steps, run = job_of(asked, request)
    with progress(n_steps, quiet=as_json or bool(layout)) as step:
        found = run(step)
    if earlier is not None:
        from verify.bench.against import beside

        found = beside(found, earlier)
    if keep is not None:
        options = [word for name, text in given.items() for word in (f"--{name}", text)]
        options += ["--against", _place(against)] if against is not None else []
        _keep(found, keep, _place(Path(scene)), overrides, (*options, *["--cold"] * cold, *["--push"] * push))
    _tell(found, "json" if as_json else layout)


def _keep(found: "BenchFound", folder: Path, scene: str, overrides: tuple[str, ...], options: tuple[str, ...]) -> None:
    """Write the page with the line that it was made by."""
    from verify.bench.keeping import page
    from verify.files import write_whole

    line = command_line("bench", (scene,), overrides, (*options, "--keep", _place(folder)))
    write_whole(folder / f"{found.scene}.md", page(found, line), "--keep")


def _place(path: Path) -> str:
    """A path as a page names it: of one that this machine alone has, the last name."""
    return path.name if path.is_absolute() else path.as_posix()


def _earlier(against: Path | None) -> Any:
    """What an earlier run found, None where none is named. Raises InputError."""
    if against is None:
        return None
    from verify.bench.against import read_earlier

    return read_earlier(against)


def _tell(found: "BenchFound", layout: str | None) -> None:
    """As a person reads it, or in a layout."""
    if layout:
        from verify.report.plain import text_of

        click.echo(text_of(found, layout), nl=False)
    else:
        from verify.report.terminal import print_found

        print_found(found)
