"""A row of what is refused: input after input, each by the beginning of its sentence, and what stands beside it."""

from collections.abc import Callable, Iterable
from time import perf_counter
from typing import ClassVar, TypeAlias

import msgspec

from verify.errors import InputError
from verify.models.compiling import Call
from verify.stress.kind import Kind, Outcome, Row

Ask: TypeAlias = Callable[[], object]
"""Raises InputError where it is refused."""


class Case(msgspec.Struct, frozen=True):
    """One input that is refused, and one beside it that is not."""

    said: str
    """How its sentence begins: the field, with the value where it has one."""
    ask: Ask
    taken: Ask | None = None
    """On the other side of the limit; None where a word is wrong, or every other row takes what is right."""

    def tried(self) -> tuple[str, str]:
        """(the sentence, what is wrong with it)."""
        said, broke = _answer(self.ask)
        if not said:
            return said, f"{self.said!r} is {broke or 'not refused'}"
        if not said.startswith(self.said):
            return said, f"{self.said!r} is refused by another sentence: {said}"
        refused, broke = _answer(self.taken) if self.taken else ("", "")
        return said, f"beside {self.said!r}: {refused or broke}" if refused or broke else ""


def _answer(ask: Ask) -> tuple[str, str]:
    """(the sentence of a refusal, whatever else came in its place)."""
    try:
        ask()
    except InputError as error:
        return str(error), ""
    except Exception as error:  # the traceback that was promised away
        return "", f"{type(error).__name__} in place of a sentence: {error}"
    return "", ""


class Refusals(Row, frozen=True, kw_only=True, eq=False):
    """Inputs refused by the names of their fields."""

    kind: ClassVar[Kind] = "refusal"
    cases: tuple[Case, ...]

    @property
    def promised(self) -> str:
        """How many."""
        return f"InputError names each of {len(self.cases)} fields"

    def run(self) -> Outcome:
        """Every sentence, and the first that is not as promised."""
        began = perf_counter()
        told = [case.tried() for case in self.cases]
        reason = next((why for _, why in told if why), "")
        sentences = tuple(said for said, _ in told)
        found = self._outcome(began, self.promised, sentences[-1] or None, reason)
        return msgspec.structs.replace(found, said=sentences)


def refusals(name: str, title: str, why: str, *cases: Case, kernels: Callable[[], Iterable[Call]] = tuple) -> Refusals:
    """A row of such cases, with the compiled loops that what is taken runs."""
    at = (float(len(cases)),)
    return Refusals(id=name, title=title, why=why, along="refusals", at=at, cases=cases, kernels=kernels)
