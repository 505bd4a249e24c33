"""A bench as a dated page of Markdown, to be kept beside the source: what it says holds for that day and machine."""

from textwrap import fill

from verify.bench.found import BenchFound
from verify.studies.told import Table
from verify.words import cell


def page(found: BenchFound, command: str) -> str:
    """The whole page, of what a command found, without a name of the machine."""
    made = (*found.machine.values(), *(f"{name} {version}" for name, version in found.versions.items()))
    made += () if found.load is None else (f"{found.load:g} processes to a core at its end",)
    parts = [
        f"# Run time against error: {found.scene}\n",
        _wrapped(
            f"{found.date}, on {', '.join(made)}. Seconds are of the processor, in one thread; medians of interleaved "
            "rounds. Ratios hold for this machine and these versions."
        ),
        _wrapped(f"Made by `{command}`."),
        "## What it says\n",
        "".join(_wrapped(f"- {fact}") for fact in found.facts()),
        *(_as_markdown(table) for table in found.tables()),
    ]
    return "\n".join(parts)


def _wrapped(text: str) -> str:
    indent = "  " if text.startswith("- ") else ""
    return fill(text, 120, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False) + "\n"


def _as_markdown(table: Table) -> str:
    heads = "| " + " | ".join(column.head for column in table.columns) + " |"
    rule = "| " + " | ".join("---" if column.left else "---:" for column in table.columns) + " |"
    rows = (
        "| "
        + " | ".join(
            cell(value, column.form, column.factor, column.unit)
            for value, column in zip(row, table.columns, strict=True)
        )
        + " |"
        for row in table.rows
    )
    notes = "".join(_wrapped(f"- {note}") for note in table.notes)
    return f"## {table.title[:1].upper()}{table.title[1:]}\n\n" + "\n".join([heads, rule, *rows]) + f"\n\n{notes}"
