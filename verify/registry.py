"""What there is to choose from, by name: what the package brings, what was registered, what others installed."""

import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, MutableMapping
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from verify.errors import InputError, near_name, one_line, shown

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint


class Named(Protocol):
    """Anything with a name."""

    @property
    def name(self) -> str:
        """By which it is asked for."""


T = TypeVar("T", bound=Named)


_UNUSABLE: dict[tuple[str, str], str] = {}
"""Why an entry point of another package is left out, by its group and name."""


def unusable() -> tuple[str, ...]:
    """A sentence for every entry point that was looked at so far and cannot be used."""
    return tuple(one_line(why) for why in _UNUSABLE.values())


class Registry(MutableMapping[str, T]):
    """Things of one kind by their names; each of the package's own is imported when it is first asked for.

    Entry points of other packages are looked up, and imported, only where a name is not known here or where all are
    asked for. One that cannot be is left out; asked for by name it is refused with the reason.
    """

    def __init__(
        self,
        what: str,
        group: str,
        own: Iterable[T] = (),
        homes: Mapping[str, str] | None = None,
        refuses: Callable[[T], str] = lambda one: "",
    ) -> None:
        """`what` a message calls one; `group` of entry points; `own` by value, `homes` by 'module:attribute'.

        `refuses` says what is wrong with one from outside, if anything is.
        """
        self._what, self._group, self._refuses = what, group, refuses
        self._found: dict[str, T] = {one.name: one for one in own}
        self._homes = dict(homes or {})
        self._names = [*self._found, *self._homes]
        self._outside = False
        self.built_in = tuple(self._names)
        """The names of what comes with the package, whatever others have added."""

    def named(self, name: str, field: str = "") -> T:
        """The one of that name. Raises InputError, with the nearest name, for one that nobody has."""
        if not isinstance(name, str):
            raise InputError(f"{field or self._what} = {shown(name)}: give a name, {near_name('', tuple(self))}")
        try:
            return self[name]
        except KeyError:
            raise InputError(f"{field or self._what} = {name!r} is not known: {near_name(name, tuple(self))}") from None

    def register(self, one: T) -> T:
        """Add one from outside the package, or put another in the place of one; returns it. Raises InputError."""
        name = getattr(one, "name", None)
        if not isinstance(name, str) or not name:
            raise InputError(f"{self._what} = {one!r} has no name: give it one")
        if why := self._refuses(one):
            raise InputError(f"{self._what} = {name!r} {why}")
        self[name] = one
        return one

    @contextmanager
    def registered(self, *ones: T) -> Iterator[None]:
        """The same for a while."""
        held = {one.name: self[one.name] for one in ones if one.name in self}
        for one in ones:
            self.register(one)
        try:
            yield
        finally:
            for one in ones:
                if one.name in held:
                    self.register(held[one.name])
                else:
                    del self[one.name]

    def own(self) -> tuple[str, ...]:
        """The names of what is known without looking into other packages."""
        return tuple(self._names)

    def __getitem__(self, name: str) -> T:
        if name not in self._names:
            self._look_outside()
        if name not in self._names:
            if why := _UNUSABLE.get((self._group, name)):
                raise InputError(why)
            raise KeyError(name)
        if name not in self._found:
            self._found[name] = _imported(self._homes[name])
        return self._found[name]

    def __setitem__(self, name: str, one: T) -> None:
        if name not in self._names:
            self._names.append(name)
        self._found[name] = one

    def __delitem__(self, name: str) -> None:
        self._names.remove(name)
        self._found.pop(name, None)

    def __iter__(self) -> Iterator[str]:
        self._look_outside()
        return iter(tuple(self._names))

    def __len__(self) -> int:
        self._look_outside()
        return len(self._names)

    def __contains__(self, name: object) -> bool:
        if name not in self._names:
            self._look_outside()
        return name in self._names

    def _look_outside(self) -> None:
        """Take up what other packages have declared as entry points; a name of our own stays ours."""
        if self._outside:
            return
        self._outside = True
        if not may_be_declared(self._group, tuple(sys.path)):
            return
        from importlib.metadata import entry_points

        for point in entry_points(group=self._group):
            if point.name not in self._names:
                self._take_up(point)

    def _take_up(self, point: "EntryPoint") -> None:
        """Import what another package declares; whatever goes wrong there is that package's, and is kept in words."""
        try:
            found: T = _imported(point.value)
            if getattr(found, "name", None) != point.name:
                raise InputError(f"it is no {self._what} of that name")
            if problem := self._refuses(found):
                raise InputError(f"it {problem}")
        except Exception as error:
            package = point.dist.name if point.dist else "another package"
            why = str(error) if isinstance(error, InputError) else f"{type(error).__name__}: {error}"
            _UNUSABLE[self._group, point.name] = (
                f"{self._what} = {point.name!r} of {package}, {point.value}, cannot be used ({why}): mend that package "
                "or uninstall it"
            )
        else:
            self[point.name] = found


def may_be_declared(group: str, path: tuple[str, ...]) -> bool:
    """Whether an installed package may have entry points of a group, without `importlib.metadata`, slow to import.

    Packages are folders `*.dist-info` and their older kin on the path. Where anything else may have some (an archive on
    the path, a finder of its own), and where a file cannot be read, there may be.
    """
    others = (finder for finder in sys.meta_path if finder.__module__ != _PATH_FINDER)
    return any(hasattr(finder, "find_distributions") for finder in others) or f"[{group}]" in _declared(path)


@cache
def _declared(path: tuple[str, ...]) -> str:
    """What the packages on a path declare, without spaces; every group of ours where that cannot be told."""
    try:
        return "\n".join(text for folder in dict.fromkeys(path) for text in _declared_in(Path(folder or ".")))
    except (OSError, UnicodeError):
        return _ANY


_PATH_FINDER = "_frozen_importlib_external"
_ANY = "".join(f"[verify.{what}]" for what in ("models", "quantities", "studies"))


def _declared_in(folder: Path) -> Iterator[str]:
    """The entry points that packages in a folder of the path declare."""
    if not folder.is_dir():
        yield _ANY if folder.exists() else ""  # an archive
        return
    for name in os.listdir(folder):
        if name.endswith((".dist-info", ".egg-info", ".egg")):
            home, egg = folder / name, name.endswith(".egg")
            if egg and home.is_file():
                yield _ANY
            points = home / ("EGG-INFO" if egg else "") / "entry_points.txt"
            if points.is_file():
                yield points.read_text("utf-8").replace(" ", "")


def _imported(home: str) -> Any:
    """What stands at 'module:attribute'; a class is called for its one instance."""
    from importlib import import_module

    module, _, attribute = home.partition(":")
    found = getattr(import_module(module), attribute)
    return found() if isinstance(found, type) else found
