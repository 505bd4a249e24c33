"""`verify cases`: problems of known answer for any engine: the list, a sheet, the files of an engine."""

from pathlib import Path
from typing import Any

import click

from verify.commands.shared import format_options, show
from verify.errors import InputError
from verify.report.result import Column, Result, Table
from verify.sheets.sheet import load, names
from verify.sheets.write import MODELS, engines, write


@click.command()
@click.argument("name", required=False)
@click.option("--to", "folder", metavar="FOLDER", help="Write the sheet, and with --engine model and script.")
@click.option("--engine", metavar="NAME", help=f"{', '.join(MODELS)}; for any other the sheet says what to build.")
@click.option("--count", type=click.IntRange(min=2), metavar="N", help="Links of the model. Default: the sheet's.")
@format_options
def cases(name: str | None, folder: str | None, engine: str | None, count: int | None, **formats: Any) -> None:
    """List the cases for any engine, show one, or write its files: build it, record a table, `verify judge` it.

    Example: `verify cases ring-down --to ring --engine mujoco`
    """
    if name is None:
        if folder or engine:
            raise click.UsageError("Name a case: verify cases ring-down --to FOLDER.")
        rows = [(one, load(one).title, len(load(one).figures), ", ".join(engines(one)) or "sheet") for one in names()]
        columns = [Column("case"), Column("title"), Column("figures"), Column("files for")]
        return show(Result(tables=[Table("", columns, rows)]), **formats)
    if folder is None:
        if engine or count:
            raise InputError("to is missing: give the folder of the files, --to FOLDER")
        return show(told(name), **formats)
    written = write(name, Path(folder), engine or "", count)
    click.echo(f"wrote {', '.join(written)} into {folder}")
    if script := next((one for one in written if one.endswith("_record.py")), None):
        click.echo(f"next: cd {folder}; python {script}; verify judge {name} run.csv")
    else:
        click.echo(
            f"next: build what sheet.toml says, record {', '.join(load(name).columns)}; verify judge {name} run.csv"
        )
    return None


def told(name: str) -> Result:
    """A sheet for a person."""
    sheet = load(name)
    rows = [
        (one.name, one.meaning, one.exact, one.unit or "1", one.within, one.order or None, one.source)
        for one in sheet.figures
    ]
    columns = [Column("figure"), Column("meaning"), Column("exact", "", ".10g"), Column("unit")]
    columns += [Column("passes within", "", ".3g"), Column("order, at least"), Column("source")]
    heads = [Column("name"), Column("value", "", ".10g"), Column("least error that fails", percent=True, format=".2g")]
    parameters = [(name, value, sheet.resolution(name)) for name, value in sheet.parameters.items()]
    given = Table("Parameters, SI", heads, parameters)
    notes = [f"Build: {' '.join(sheet.build.split())}", f"Record: {' '.join(sheet.record.split())}"]
    notes += [f"The record cannot tell {sheet.blind}."] * bool(sheet.blind)
    notes.append(
        f"Columns: {', '.join(sheet.columns)}. Files for: {', '.join(engines(name)) or 'none, the sheet alone'}."
    )
    return Result(f"{sheet.title}.", [Table("Figures", columns, rows, notes), given], data={"case": name})
