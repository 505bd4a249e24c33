"""The type of a case, a problem of known answer, and the table of cases by name."""

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from verify.errors import InputError

Run = TypeVar("Run", bound=Callable[..., float])


@dataclass(frozen=True)
class Case:
    """A figure with a published or closed-form value; SI units, or dimensionless as its file says."""

    name: str
    inputs: Mapping[str, Any]
    """Of the problem, keyword arguments of `run`."""
    exact: float
    uncertainty: float
    """Largest absolute error of `exact`: digits of a table, terms that a closed form neglects, rounding."""
    source: str
    run: Callable[..., float]
    """The model, named by its docstring; an argument `count` is its number of links, points or steps."""

    @property
    def sized(self) -> bool:
        """Whether a `count` may be given."""
        return "count" not in self.inputs and "count" in inspect.signature(self.run).parameters

    def value(self, count: int | None = None) -> float:
        """The figure by the model. Raises InputError as `run` does, and for a `count` that it does not have."""
        if count is not None and not self.sized:
            raise InputError(f"count = {count!r}: the size of case {self.name!r} is fixed, leave it out")
        return float(self.run(**self.inputs, **({} if count is None else {"count": count})))

    def error(self, count: int | None = None) -> float:
        """Signed error of the figure: relative, absolute where the exact value is zero."""
        return (self.value(count) - self.exact) / (abs(self.exact) or 1.0)


CASES: dict[str, Case] = {}
"""Cases of the files that are imported; `table` imports all."""


def case(name: str, exact: float, uncertainty: float, source: str, **inputs: Any) -> Callable[[Run], Run]:
    """Add a case that runs the decorated function on these inputs; see `Case`."""

    def add(run: Run) -> Run:
        CASES[name] = Case(name, inputs, exact, uncertainty, source, run)
        return run

    return add
