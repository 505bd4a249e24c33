"""What stands under a field in the source, told by `help` too: read when it is asked for, not when it is imported."""

from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING

import msgspec

if TYPE_CHECKING:
    import ast


class _Told(msgspec.StructMeta):
    """Makes classes whose docstring goes on with what stands under their fields, put together where somebody looks."""

    @property
    def __doc__(cls) -> str:  # type: ignore[override]  # noqa: N805
        from inspect import cleandoc

        fields = "\n".join(f"{name} : {kind}\n    {said}" for name, (kind, said) in fields_of(cls).items())
        return f"{cleandoc(cls.__dict__.get('__doc__') or '')}\n\nFields\n------\n{fields}\n"


class Value(msgspec.Struct, metaclass=_Told, frozen=True):
    """A value whose fields `help` tells of: their types, and the words below them in the source with their units."""


@cache
def fields_of(owner: type) -> dict[str, tuple[str, str]]:
    """The fields of a class, inherited ones first: (type, what stands under it) by name; none without the source."""
    found: dict[str, tuple[str, str]] = {}
    for one in reversed(owner.__mro__):
        found |= _written(one)
    return found


def _written(owner: type) -> dict[str, tuple[str, str]]:
    """The same, of those that a class states itself."""
    import ast
    from inspect import cleandoc

    body = _classes(owner.__module__).get(owner.__qualname__, [])
    found = {}
    for statement, after in pairwise([*body, ast.Pass()]):
        if not (isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name)):
            continue
        text = after.value.value if isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant) else ""
        stated = statement.value is not None and not isinstance(statement.value, ast.Call)
        default = f" = {ast.unparse(statement.value)}" if stated and statement.value else ""
        said = cleandoc(text).replace("\n", "\n    ") if isinstance(text, str) else ""
        found[statement.target.id] = ast.unparse(statement.annotation) + default, said
    return found


@cache
def _classes(module: str) -> "dict[str, list[ast.stmt]]":
    """The bodies of a module's classes by name; none where its source is not there."""
    import ast
    from inspect import getsource
    from sys import modules

    try:
        tree = ast.parse(getsource(modules[module]))
    except (KeyError, OSError, TypeError):
        return {}
    return {node.name: node.body for node in tree.body if isinstance(node, ast.ClassDef)}
