"""Docstrings of this package are plain words: what reStructuredText would read as signs of its own is escaped.

`name` between backticks is code. Fields of a value, which `help` tells behind its docstring (`verify.field_docs`), are
listed as parameters are; the slots behind them are left out.
"""

import re

CODE = re.compile(r"(`[^`]+`)")
SIGNS = re.compile(r"([\\*|]|(?<=\w)_(?!\w))")


def escaped(line):
    """A line in which only what stands between backticks is a sign."""
    parts = CODE.split(line)
    return "".join(f"`{part}`" if k % 2 else SIGNS.sub(r"\\\1", part) for k, part in enumerate(parts))


def rule(line):
    """Whether a line underlines the head of a section."""
    return bool(line.strip()) and not line.strip().strip("-")


def process(app, what, _name, obj, _options, lines):
    """Escape a docstring in place; keep whose members come next."""
    lines[:] = [line if rule(line) else escaped(line) for line in lines]
    if what == "class":
        app.env.temp_data["verify_owner"] = obj


def skip(app, what, name, _obj, _skip, _options):
    """Leave out the fields of a value as members; they stand among its parameters."""
    from verify.field_docs import Value

    owner = app.env.temp_data.get("verify_owner") if what == "class" else None
    is_value = isinstance(owner, type) and issubclass(owner, Value)
    return True if is_value and name in owner.__struct_fields__ else None


def setup(app):
    """Before napoleon reads the sections."""
    app.connect("autodoc-process-docstring", process, priority=400)
    app.connect("autodoc-skip-member", skip)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
