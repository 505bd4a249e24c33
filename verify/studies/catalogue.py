"""Which studies there are: those of the package, and any that is registered under `verify.studies`."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, cast

from verify.registry import Registry
from verify.scenes.sections import SECTIONS
from verify.studies.kind import Study

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

STUDIES = cast(Registry[Study[Any, Any]], SECTIONS)
"""By name, in the order in which they are run."""


def asked_of(scene: "Scene") -> Iterator[tuple[Study[Any, Any], Any]]:
    """Every study that a scene asks for, with what it asks."""
    for name in STUDIES.own():  # reading the scene has looked up those of other packages that it has sections of
        study = STUDIES[name]
        if (asked := study.asked(scene)) is not None:
            yield study, asked
