"""The suite's own sources, parsed and walked once for all tests that read them."""

import ast
from functools import cache
from pathlib import Path

import verify

PACKAGE = Path(verify.__file__).parent


@cache
def paths():
    return tuple(sorted(PACKAGE.rglob("*.py")))


@cache
def tree_of(path):
    return ast.parse(path.read_text("utf-8"))


@cache
def nodes_of(path):
    """Every node of a file."""
    return tuple(ast.walk(tree_of(path)))


def calls_of(path, name):
    """The calls of a function by its bare name."""
    return [node for node in nodes_of(path) if isinstance(node, ast.Call) and getattr(node.func, "id", "") == name]
