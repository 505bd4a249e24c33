"""Small faults of one expression each: which a source can have, and a fair draw of them."""

import ast
import random
import re
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

SWAPPED: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.Pow: ast.Mult,
    ast.FloorDiv: ast.Div,
    ast.Mod: ast.Mult,
}
COMPARED: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.LtE, ast.Gt),
    ast.LtE: (ast.Lt, ast.GtE),
    ast.Gt: (ast.GtE, ast.Lt),
    ast.GtE: (ast.Gt, ast.LtE),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
}
DROPPED_CALLS = ("abs", "max", "min", "sqrt", "np.abs", "np.clip", "np.conj", "np.maximum", "np.minimum", "np.sqrt")
ORDERLESS = ("isinstance", "zip", "hasattr", "getattr", *DROPPED_CALLS)
"""Calls whose arguments are not exchanged."""
COMPILED = re.compile(r"^(part|lean|jit|inline)\b")
"""Decorators of kernels."""


@dataclass(frozen=True)
class Fault:
    """One expression or statement of a file, as bytes `start` to `end`, and what stands there in its place."""

    kind: str
    start: int
    end: int
    line: int
    last_line: int
    function: str
    """Dotted; that of a class in its body; empty in the module itself."""
    at_import: bool
    """Whether it runs when its module is imported: outside functions, and in what their arguments are by default."""
    in_kernel: bool
    old: str
    new: str

    def planted(self, source: bytes) -> bytes:
        """The source with this fault."""
        return source[: self.start] + self.new.encode() + source[self.end :]


def _bracketed(node: ast.AST) -> str:
    return f"({ast.unparse(node)})"


def _of_sum(node: ast.BinOp) -> Iterator[tuple[str, str]]:
    """Another operator, another sign, the second operand gone."""
    if isinstance(node.left, ast.Constant) and isinstance(node.left.value, str):
        return
    if type(node.op) in SWAPPED:
        yield "operator", _bracketed(ast.BinOp(node.left, SWAPPED[type(node.op)](), node.right))
    if isinstance(node.op, ast.Add | ast.Sub | ast.Mult | ast.Div) and not isinstance(node.left, ast.List | ast.Tuple):
        yield "sign", _bracketed(ast.BinOp(ast.UnaryOp(ast.USub(), node.left), node.op, node.right))
        yield ("term" if isinstance(node.op, ast.Add | ast.Sub) else "factor"), _bracketed(node.left)


def _of_comparison(node: ast.Compare) -> Iterator[tuple[str, str]]:
    """Each of its signs turned, or with its edge counted otherwise."""
    for i, sign in enumerate(node.ops):
        for other in COMPARED[type(sign)]:
            signs = [*node.ops[:i], other(), *node.ops[i + 1 :]]
            yield "comparison", _bracketed(ast.Compare(node.left, signs, node.comparators))


def _of_constant(node: ast.Constant) -> Iterator[tuple[str, str]]:
    """A truth turned, a number by one or by a thousandth."""
    value = node.value
    if isinstance(value, bool):
        yield "constant", str(not value)
    elif isinstance(value, int):
        yield "constant", str(value + 1)
        yield from [("constant", str(value - 1))] if value > 0 else []
    elif isinstance(value, float):
        yield "constant", repr(value + 1.0)
        yield from [("thousandth", repr(1.001 * value)), ("constant", "0.0")] if value else []


def _of_call(node: ast.Call) -> Iterator[tuple[str, str]]:
    """Its first two arguments exchanged; a call that bounds or cuts gone."""
    name, given = ast.unparse(node.func), node.args
    if any(isinstance(one, ast.Starred | ast.GeneratorExp) for one in given[:2]):
        return
    if len(given) > 1 and name not in ORDERLESS and ast.dump(given[0]) != ast.dump(given[1]):
        yield "arguments", ast.unparse(ast.Call(node.func, [given[1], given[0], *given[2:]], node.keywords))
    if name in DROPPED_CALLS and given:
        yield "call", _bracketed(given[0])


def _of_expression(node: ast.expr) -> Iterator[tuple[str, str]]:
    if isinstance(node, ast.BinOp):
        yield from _of_sum(node)
    elif isinstance(node, ast.Compare):
        yield from _of_comparison(node)
    elif isinstance(node, ast.Constant):
        yield from _of_constant(node)
    elif isinstance(node, ast.Call):
        yield from _of_call(node)
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.Not):
        yield ("sign" if isinstance(node.op, ast.USub) else "logic"), _bracketed(node.operand)
    elif isinstance(node, ast.BoolOp):
        other = ast.Or() if isinstance(node.op, ast.And) else ast.And()
        yield "logic", _bracketed(ast.BoolOp(other, node.values))


def _found(node: ast.AST) -> Iterator[tuple[str, ast.AST, str]]:
    """(kind, what is replaced, by what) at a node itself."""
    if isinstance(node, ast.Raise):
        yield "refusal", node, "pass"
    elif isinstance(node, ast.AugAssign | ast.Continue | ast.Break) or (
        isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)
    ):
        yield "statement", node, "pass"
    elif isinstance(node, ast.If | ast.IfExp):
        yield "condition", node.test, f"(not {_bracketed(node.test)})"
    elif isinstance(node, ast.Return | ast.Assign) and isinstance(node.value, ast.Tuple) and len(node.value.elts) > 1:
        first, second, *rest = node.value.elts
        yield "values", node.value, ast.unparse(ast.Tuple([second, first, *rest], ast.Load()))[1:-1]
    elif isinstance(node, ast.expr):
        for kind, new in _of_expression(node):
            yield kind, node, new


class _Place(NamedTuple):
    """Where a node stands."""

    function: str = ""
    at_import: bool = True
    in_kernel: bool = False


def _walked(node: ast.AST, place: _Place) -> Iterator[tuple[str, ast.AST, str, _Place]]:
    """All of a tree, but for what does not run or is words: imports, annotations, docstrings, messages."""
    if isinstance(node, ast.Import | ast.ImportFrom | ast.JoinedStr | ast.arg):
        return
    if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
        return
    inside, defaults = list[ast.AST](ast.iter_child_nodes(node)), list[ast.AST]()
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        place = _within(node, place)
        inside = list(node.body)
    if isinstance(node, ast.FunctionDef):
        defaults = [one for one in (*node.args.defaults, *node.args.kw_defaults) if one]
    elif isinstance(node, ast.AnnAssign):
        inside = [node.value] if node.value else []
    elif isinstance(node, ast.Raise) or (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)):
        inside = []
    for kind, replaced, new in _found(node):
        yield kind, replaced, new, place
    for one in defaults:
        yield from _walked(one, place)
    if isinstance(node, ast.FunctionDef):
        place = place._replace(at_import=False)
    for one in inside:
        yield from _walked(one, place)


def _within(node: ast.FunctionDef | ast.ClassDef, place: _Place) -> _Place:
    """That of its defaults or its body's first level."""
    kernel = any(COMPILED.match(ast.unparse(one)) for one in node.decorator_list)
    return _Place(f"{place.function}.{node.name}".strip("."), place.at_import, place.in_kernel or kernel)


def faults_of(source: bytes) -> list[Fault]:
    """All faults that a module can have; a few do not compile and are left out of a draw."""
    begins = [0]
    for line in source.splitlines(keepends=True):
        begins.append(begins[-1] + len(line))
    found: list[Fault] = []
    for kind, node, new, place in _walked(ast.parse(source), _Place()):
        assert isinstance(node, ast.expr | ast.stmt)
        assert node.end_lineno is not None
        assert node.end_col_offset is not None
        start, end = begins[node.lineno - 1] + node.col_offset, begins[node.end_lineno - 1] + node.end_col_offset
        old = source[start:end].decode()
        fault = Fault(kind, start, end, node.lineno, node.end_lineno, *place, old, new)
        if old != new:
            found.append(fault)
    return found


def _compiles(source: bytes) -> bool:
    try:
        compile(source, "planted", "exec")
    except SyntaxError:
        return False
    return True


def drawn(sources: dict[str, bytes], number: int, seed: int, kernels: bool | None = None) -> list[tuple[str, Fault]]:
    """So many of (module, fault): modules by how much they hold, kinds by the root of how often they occur, one a line.

    The same seed draws the same faults from the same sources. `kernels`: in compiled functions alone, or none there.
    """
    chance, left = random.Random(seed), dict[str, dict[str, list[Fault]]]()
    for module, source in sorted(sources.items()):
        kinds = defaultdict[str, list[Fault]](list)
        for fault in faults_of(source):
            if kernels in (None, fault.in_kernel):
                kinds[fault.kind].append(fault)
        for faults in kinds.values():
            chance.shuffle(faults)
        if kinds:
            left[module] = kinds
    found, taken = list[tuple[str, Fault]](), set[tuple[str, int]]()
    weights = {module: sum(map(len, kinds.values())) for module, kinds in left.items()}
    while len(found) < number and left:
        module = chance.choices(list(left), [weights[one] for one in left])[0]
        kinds = left[module]
        kind = chance.choices(list(kinds), [len(faults) ** 0.5 for faults in kinds.values()])[0]
        fault = kinds[kind].pop()
        if not kinds[kind]:
            del kinds[kind]
        if not kinds:
            del left[module]
        if (module, fault.line) not in taken and _compiles(fault.planted(sources[module])):
            taken.add((module, fault.line))
            found.append((module, fault))
    return found
