"""What there is to ask for, listed in the terminal: sections of a scene, their keys."""

from typing import TYPE_CHECKING, Any

from rich.box import SIMPLE_HEAD
from rich.table import Table
from rich.text import Text

from verify.report.terminal import Terminal

if TYPE_CHECKING:
    from verify.scenes.described import Key


def print_sections(listed: list[dict[str, Any]]) -> None:
    """Every section with how many keys it has and what it is."""
    console = Terminal()
    table = Table(box=SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    table.add_column("section", no_wrap=True)
    table.add_column("keys", justify="right")
    table.add_column("what it is")
    for one in listed:
        table.add_row(one["section"], str(one["keys"]), Text(one["meaning"]))
    console.print(table)
    console.print("keys of one: verify keys SECTION, for instance verify keys beam.spring")


def print_keys(section: str, meaning: str, keys: "tuple[Key, ...]") -> None:
    """The keys of one section in four columns."""
    console = Terminal()
    console.print(Text(f"{section}: {meaning}", style="bold"))
    table = Table(box=SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    for name, widest in (("key", None), ("type", 20), ("default", 14), ("unit and meaning", None)):
        table.add_column(name, no_wrap=name == "key", max_width=widest, overflow="fold")
    for one in keys:
        default = "required" if one.required else "–" if one.default is None else _plain(one.default)
        table.add_row(one.key, Text(one.type), Text(default), Text(one.meaning))
    console.print(table)


def _plain(value: Any) -> str:
    """A default as TOML writes it, short."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_plain, value))}]"
    return repr(value).replace("'", '"')
