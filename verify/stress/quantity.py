"""A row of the stress table as a named figure, for gates."""

from typing import TYPE_CHECKING, Annotated, ClassVar

from msgspec import Meta

from verify.judge.workbench import Workbench
from verify.quantities.kind import Arguments, Quantity

if TYPE_CHECKING:
    from collections.abc import Iterable

    from verify.models.compiling import Call
    from verify.scenes.scene import Scene


class OfRow(Arguments, frozen=True, kw_only=True):
    """A row of the stress table, on its own beams."""

    reads: ClassVar[tuple[str, ...]] = ()
    row: Annotated[str, Meta(description="its id, as verify stress --list has it")]


def _share(a: OfRow, scene: "Scene", bench: Workbench) -> float:
    from verify.stress.figures import outcome_on

    return outcome_on(bench, a.row).share


def _kernels(a: OfRow, scene: "Scene") -> "Iterable[Call]":
    from verify.stress.catalogue import row

    return row(a.row).kernels()


SHARE = Quantity(
    "stress.share",
    "1",
    "Of a row's promise: error over floor, exponent over promised growth; 0 of what is refused as promised.",
    OfRow,
    "promise",
    _share,
    kernels=_kernels,
)
