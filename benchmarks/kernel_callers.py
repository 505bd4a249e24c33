"""From which lines of Python a compiled function is reached: a trace of lines ends where compiled code begins."""

import ast
from collections import defaultdict
from collections.abc import Iterator

from benchmarks.fault_kinds import COMPILED

Name = tuple[str, str]
"""A module, by its path, and a function of it."""
Line = tuple[str, int]
"""A module, and a line; nought for what a module itself runs when it is imported."""


def _module(dotted: str, sources: dict[str, bytes]) -> str:
    """The path of a module that is among the sources; empty where it is not."""
    path = dotted.replace(".", "/") + ".py"
    return path if path in sources else ""


def _imported(tree: ast.Module, sources: dict[str, bytes]) -> tuple[dict[str, Name], dict[str, str]]:
    """What names of a file stand for: functions of other modules, and modules."""
    functions, modules = dict[str, Name](), dict[str, str]()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module:
            for one in node.names:
                own = one.asname or one.name
                if inner := _module(f"{node.module}.{one.name}", sources):
                    modules[own] = inner
                elif home := _module(node.module, sources):
                    functions[own] = home, one.name
    return functions, modules


def _kernel(node: ast.AST) -> bool:
    return isinstance(node, ast.FunctionDef) and any(COMPILED.match(ast.unparse(one)) for one in node.decorator_list)


def _named(node: ast.AST, function: str) -> Iterator[tuple[ast.expr, str]]:
    """Each name and attribute under a node, with the kernel that it stands in, if any."""
    for one in ast.iter_child_nodes(node):
        within = one.name if isinstance(one, ast.FunctionDef) and _kernel(one) else function
        if isinstance(one, ast.Name | ast.Attribute):
            yield one, within
        yield from _named(one, within)


def _references(sources: dict[str, bytes]) -> dict[Name, set[tuple[str, str, int]]]:
    """Where each function is named: (module, kernel or nothing, line)."""
    found = defaultdict[Name, set[tuple[str, str, int]]](set)
    for module, source in sources.items():
        tree = ast.parse(source)
        functions, modules = _imported(tree, sources)
        functions |= {one.name: (module, one.name) for one in tree.body if isinstance(one, ast.FunctionDef)}
        inside = {id(one) for outer in tree.body if isinstance(outer, ast.FunctionDef) for one in ast.walk(outer)}
        for node, kernel in _named(tree, ""):
            if isinstance(node, ast.Name):
                target = functions.get(node.id)
            else:
                home = modules.get(node.value.id) if isinstance(node.value, ast.Name) else None
                target = (home, node.attr) if home else None
            if target:
                found[target].add((module, kernel, node.lineno if id(node) in inside else 0))
    return found


def callers(sources: dict[str, bytes]) -> dict[Name, set[Line]]:
    """The lines outside kernels from which each function that anything names is reached, through kernels or at once."""
    references, found = _references(sources), dict[Name, set[Line]]()
    for name in references:
        lines, seen, open_ = set[Line](), {name}, [name]
        while open_:
            for module, kernel, line in references.get(open_.pop(), ()):
                above = module, kernel
                if not kernel:
                    lines.add((module, line))
                elif above not in seen:
                    seen.add(above)
                    open_.append(above)
        found[name] = lines
    return found
