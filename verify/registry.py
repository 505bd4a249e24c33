"""Registries of models, quantities and studies by name, extended by entry points of other packages."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from importlib import import_module
from typing import Any, Generic, TypeVar

from verify.errors import InputError, near_name, shown

T = TypeVar("T")


class Registry(Mapping[str, T], Generic[T]):
    """Members by name, each imported at its first use.

    `what` is a member's name in messages. Members of this package are `members`, objects with a `name`, and `homes`,
    'module:attribute' by name; others come from entry points of `group`, which are looked up for an unknown name or
    where all members are listed. `refuses` returns what is wrong with a member of another package, '' if nothing.
    """

    def __init__(
        self,
        what: str,
        group: str,
        members: Iterable[T] = (),
        homes: Mapping[str, str] | None = None,
        refuses: Callable[[T], str] = lambda member: "",
    ) -> None:
        self._what, self._group, self._refuses = what, group, refuses
        self._members: dict[str, Any] = {member.name: member for member in members} | dict(homes or {})  # type: ignore[attr-defined]
        self._unusable: dict[str, str] | None = None
        self.built_in = tuple(self._members)
        """Names of the package's own members."""

    def named(self, name: str, field: str = "") -> T:
        """The member of that name. Raises InputError for an unknown one, and for an entry point that fails."""
        if isinstance(name, str) and name in self:
            return self[name]
        if why := (self._unusable or {}).get(str(name)):
            raise InputError(why)
        nearest = near_name(name if isinstance(name, str) else "", tuple(self))
        raise InputError(f"{field or self._what} = {shown(name)} is not known: {nearest}")

    def register(self, member: T) -> T:
        """Add a member, or replace the one of its name; returns it. Raises InputError."""
        name = getattr(member, "name", None)
        if not isinstance(name, str) or not name:
            raise InputError(f"{self._what} = {member!r} has no name: give it one")
        if why := self._refuses(member):
            raise InputError(f"{self._what} = {name!r} {why}")
        self._members[name] = member
        return member

    def __getitem__(self, name: str) -> T:
        if name not in self:
            raise KeyError(name)
        if isinstance(home := self._members[name], str):
            self._members[name] = _import(home)
        member: T = self._members[name]
        return member

    def __iter__(self) -> Iterator[str]:
        self._load_entry_points()
        return iter(tuple(self._members))

    def __len__(self) -> int:
        return len(tuple(iter(self)))

    def __contains__(self, name: object) -> bool:
        if name not in self._members:
            self._load_entry_points()
        return name in self._members

    def _load_entry_points(self) -> None:
        """Load the entry points, once; one of a known name, or that cannot be used, is left out."""
        if self._unusable is not None:
            return
        self._unusable = {}
        from importlib.metadata import entry_points

        for point in entry_points(group=self._group):
            if point.name in self._members:
                continue
            try:
                member = _import(point.value)
                if getattr(member, "name", point.name) != point.name:
                    raise InputError(f"it is no {self._what} of that name")
                if why := self._refuses(member):
                    raise InputError(f"it {why}")
                self._members[point.name] = member
            except Exception as error:  # whatever a foreign module raises
                package = point.dist.name if point.dist else "another package"
                why = str(error) if isinstance(error, InputError) else f"{type(error).__name__}: {error}"
                member_of = f"{self._what} = {point.name!r} of {package}, {point.value},"
                self._unusable[point.name] = f"{member_of} cannot be used ({why}): mend that package or uninstall it"


def _import(home: str) -> Any:
    module, _, attribute = home.partition(":")
    return getattr(import_module(module), attribute)
