"""Models side by side, studies, sweeps."""

import click

from verify.commands.shared import (
    json_alone,
    load,
    overridden,
    progress,
    ruled,
    scene_name,
)
from verify.errors import InputError


@click.command()
@scene_name
@click.argument("arguments", nargs=-1, metavar="[KEY=VALUE]...")
@overridden
@click.option("--modes", metavar="LIST", help="Modes, for instance 1-5,22. Default: the scene's [convergence].")
@click.option("--counts", metavar="LIST", help="Segments and elements, for instance 10,20,49 or 10-50:10.")
@click.option("--of", "study", metavar="STUDY", help="Whatever a study of SCENE finds, by the name of its section.")
@click.option("--wave", is_flag=True, help="The motor's figures over the counts instead of modes.")
@click.option("--slider", is_flag=True, help="The slider's displacement and its run time over the counts.")
@click.option(
    "--sweep",
    "sweeps",
    multiple=True,
    metavar="AXIS=START:END:STEPS",
    help="A wave quantity over one or two axes: frequency_hz, phase_deg, position, loss_factor, count.",
)
@click.option(
    "--quantity",
    help="What a sweep maps, with its other arguments as KEY=VALUE. Default: wave.standing_wave_ratio.",
)
@ruled
@json_alone
@click.option("--csv", "layout", flag_value="csv", help="Print comma-separated values.")
@click.option("--markdown", "layout", flag_value="markdown", help="Print a Markdown table.")
def table(
    scene: str,
    arguments: tuple[str, ...],
    overrides: tuple[str, ...],
    modes: str | None,
    counts: str | None,
    study: str | None,
    wave: bool,
    slider: bool,
    sweeps: tuple[str, ...],
    quantity: str | None,
    as_json: bool,
    layout: str | None,
    rules: dict[str, str],
) -> None:
    """All discrete models side by side; any study; the motor's figures or the slider's over sizes; or a sweep.

    Example: `verify table steel-cantilever --modes 1-5 --counts 10-50:10 --wall gregory,half`
    """
    from verify.run import tables

    asked = load(scene, overrides)
    if as_json and layout:
        raise InputError(f"--json and --{layout} are two ways to print one table: give one of them")
    if arguments and not sweeps:
        raise InputError(f"{arguments[0]!r}: KEY=VALUE arguments belong to a --sweep")
    tables.check_options(
        {"--of": study is not None, "--sweep": sweeps, "--slider": slider, "--wave": wave},
        {"--modes": modes is not None, "--counts": counts is not None, "--quantity": quantity is not None}
        | {f"--{name}": True for name in rules},
    )
    if study is not None:
        job = tables.study_of(asked, study)
    elif sweeps:
        job = tables.sweep(asked, sweeps, quantity or "wave.standing_wave_ratio", arguments)
    elif slider:
        job = tables.slider(asked, counts)
    else:
        job = tables.motor(asked, counts) if wave else tables.convergence(asked, modes, counts, rules)
    with progress(job.n_steps, quiet=as_json or bool(layout)) as step:
        found = job.run(step)
    if as_json or layout:
        from verify.report.plain import text_of

        click.echo(text_of(found, layout or "json"), nl=False)
    else:
        from verify.report.terminal import print_found

        print_found(found)
