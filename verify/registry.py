"""Registries of models, quantities and studies by name, extended by entry points of other packages."""

from collections.abc import Callable, Iterable, Iterator, Mapping, MutableMapping
from contextlib import contextmanager
from importlib import import_module
from typing import TYPE_CHECKING, Any, TypeVar

from verify.errors import InputError, near_name, one_line, shown

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

T = TypeVar("T")

_UNUSABLE: dict[tuple[str, str], str] = {}


def unusable() -> tuple[str, ...]:
    """One sentence for each entry point that was looked up so far and cannot be loaded."""
    return tuple(one_line(why) for why in _UNUSABLE.values())


class Registry(MutableMapping[str, T]):
    """Members by name, each imported at its first use.

    Entry points of other packages are looked up only for an unknown name or where all members are listed. One that
    cannot be loaded is left out (see `unusable`); requested by name it raises InputError with the reason.

    Parameters
    ----------
    what : str
        What a message calls a member.
    group : str
        Group of entry points.
    own : iterable
        Members with a `name`.
    homes : mapping
        'module:attribute' by name, for members that are imported lazily.
    refuses : callable
        Returns what is wrong with a member from outside, '' if nothing.
    classes : bool
        Members are classes. If False, a class found at a home or entry point is called to make the member.
    """

    def __init__(
        self,
        what: str,
        group: str,
        own: Iterable[T] = (),
        homes: Mapping[str, str] | None = None,
        refuses: Callable[[T], str] = lambda one: "",
        classes: bool = False,
    ) -> None:
        self._what, self._group, self._refuses, self._classes = what, group, refuses, classes
        self._loaded: dict[str, T] = {one.name: one for one in own}  # type: ignore[attr-defined]
        self._homes = dict(homes or {})
        self._names = [*self._loaded, *self._homes]
        self._searched = False
        self.built_in = tuple(self._names)
        """Names of the package's own members."""

    def named(self, name: str, field: str = "") -> T:
        """The member of that name. Raises InputError, with the nearest name, for an unknown one."""
        if isinstance(name, str) and name in self:
            return self[name]
        if why := _UNUSABLE.get((self._group, str(name))):
            raise InputError(why)
        nearest = near_name(name if isinstance(name, str) else "", tuple(self))
        raise InputError(f"{field or self._what} = {shown(name)} is not known: {nearest}")

    def register(self, one: T) -> T:
        """Add a member, or replace the one of its name; returns it. Raises InputError."""
        name = getattr(one, "name", None)
        if not isinstance(name, str) or not name:
            raise InputError(f"{self._what} = {one!r} has no name: give it one")
        if why := self._refuses(one):
            raise InputError(f"{self._what} = {name!r} {why}")
        self[name] = one
        return one

    @contextmanager
    def registered(self, *ones: T) -> Iterator[None]:
        """Register members within a `with` block."""
        before = list(self._names), dict(self._loaded)
        try:
            for one in ones:
                self.register(one)
            yield
        finally:
            self._names, self._loaded = before

    def own(self) -> tuple[str, ...]:
        """The names known without a look-up of entry points."""
        return tuple(self._names)

    def __getitem__(self, name: str) -> T:
        if name not in self:
            if why := _UNUSABLE.get((self._group, name)):
                raise InputError(why)
            raise KeyError(name)
        if name not in self._loaded:
            self._loaded[name] = self._import(self._homes[name])
        return self._loaded[name]

    def __setitem__(self, name: str, one: T) -> None:
        if name not in self._names:
            self._names.append(name)
        self._loaded[name] = one

    def __delitem__(self, name: str) -> None:
        self._names.remove(name)
        self._loaded.pop(name, None)

    def __iter__(self) -> Iterator[str]:
        self._search()
        return iter(tuple(self._names))

    def __len__(self) -> int:
        self._search()
        return len(self._names)

    def __contains__(self, name: object) -> bool:
        if name not in self._names:
            self._search()
        return name in self._names

    def _search(self) -> None:
        """Load the entry points of the group, once; a name of the package's own stays its own."""
        if self._searched:
            return
        self._searched = True
        from importlib.metadata import entry_points

        for point in entry_points(group=self._group):
            if point.name not in self._names:
                self._load(point)

    def _load(self, point: "EntryPoint") -> None:
        try:
            one = self._import(point.value)
            if getattr(one, "name", point.name) != point.name and not self._classes:
                raise InputError(f"it is no {self._what} of that name")
            if problem := self._refuses(one):
                raise InputError(f"it {problem}")
        except Exception as error:
            package = point.dist.name if point.dist else "another package"
            why = str(error) if isinstance(error, InputError) else f"{type(error).__name__}: {error}"
            _UNUSABLE[self._group, point.name] = (
                f"{self._what} = {point.name!r} of {package}, {point.value}, cannot be used ({why}): mend that package "
                "or uninstall it"
            )
        else:
            self[point.name] = one

    def _import(self, home: str) -> T:
        module, _, attribute = home.partition(":")
        found: Any = getattr(import_module(module), attribute)
        return found() if isinstance(found, type) and not self._classes else found  # type: ignore[no-any-return]
