"""Which gates of a scene are about what it is run with: `--set` of a beam makes another beam of it."""

import re
from typing import TYPE_CHECKING

import msgspec

from verify.errors import InputError
from verify.quantities.catalogue import arguments_of, quantity
from verify.quantities.kind import WHAT_EXISTS

if TYPE_CHECKING:
    from pathlib import Path

    from verify.scenes.scene import Gate, Scene

LONGEST = 180
"""Characters of a report's name, which a file system can hold."""
_STATED = ("expect", "at_least", "at_most")


def keys_set(overrides: tuple[str, ...]) -> tuple[str, ...]:
    """The keys of what `--set` changes of what exists: 'beam.length'."""
    keys = (text.partition("=")[0].strip() for text in overrides)
    return tuple(dict.fromkeys(key for key in keys if key.split(".")[0] in WHAT_EXISTS))


def that_change(name_or_path: "str | Path", overrides: tuple[str, ...]) -> tuple[str, ...]:
    """Overrides without those that set anew what a scene has anyway: a beam of the same length is no other beam."""
    from verify.scenes.scene import load_scene

    def alone(*given: str) -> "Scene | None":
        try:
            return load_scene(name_or_path, given)
        except InputError:
            return None

    about = [text for text in overrides if keys_set((text,)) or _asks_otherwise(text)]
    own = alone() if about else None
    idle = {text for text in about if own is not None and alone(text) == own}
    return tuple(text for text in overrides if text not in idle)


def _asks_otherwise(text: str) -> bool:
    """Whether an override is of what a gate asks, not of its band, which is stated even where it stays the same."""
    return text.startswith("gate.") and ".arguments" in text.partition("=")[0]


def not_applicable(scene: "Scene", overrides: tuple[str, ...]) -> dict[str, str]:
    """Gates by id that were stated for something else than what `--set` makes of the scene, and why.

    A gate keeps applying where its figure depends on none of what was set, its own arguments among it, and where its
    band was set as well.
    """
    keys = keys_set(overrides)
    found = {
        gate.id: _of_its_own(gate, i, overrides) or _why(gate, keys)
        for i, gate in enumerate(scene.gate)
        if not _restated(gate, i, overrides)
    }
    return {name: why for name, why in found.items() if why}


def _restated(gate: "Gate", i: int, overrides: tuple[str, ...]) -> bool:
    """Whether its expectation was set too."""
    keys = {text.partition("=")[0].strip() for text in overrides}
    return any(f"gate.{name}.{band}" in keys for name in (gate.id, i) for band in _STATED)


def _of_its_own(gate: "Gate", i: int, overrides: tuple[str, ...]) -> str:
    """The reason where it is asked for another figure than the one that it states."""
    keys = dict.fromkeys(text.partition("=")[0].strip() for text in overrides)
    about = [key for key in keys if any(key.startswith(f"gate.{name}.arguments") for name in (gate.id, i))]
    try:
        arguments_of(quantity(gate.quantity), gate.arguments)
    except InputError:
        return ""  # judged, so that its own sentence is read
    return f"stated for other arguments: --set {', '.join(about)}" if about else ""


def _why(gate: "Gate", keys: tuple[str, ...]) -> str:
    """The reason, or nothing where the gate applies."""
    try:
        reads = quantity(gate.quantity).arguments.reads
    except InputError:
        return ""  # judged, so that its own sentence is read
    about = [key for key in keys if key.split(".")[0] in reads]
    tables = dict.fromkeys(key.split(".")[0] for key in about)
    return f"stated for another {' and '.join(tables)}: --set {', '.join(about)}" if about else ""


def applicable(scene: "Scene", overrides: tuple[str, ...]) -> "Scene":
    """The scene with the gates alone that apply."""
    left_out = not_applicable(scene, overrides)
    if not left_out:
        return scene
    return msgspec.structs.replace(scene, gate=tuple(gate for gate in scene.gate if gate.id not in left_out))


def report_name(scene: "Scene", overrides: tuple[str, ...]) -> str:
    """Of a report's file without its ending: the scene's, and behind it what `--set` changed of what exists."""
    keys = set(keys_set(overrides))
    changes = [text for text in overrides if text.partition("=")[0].strip() in keys]
    name = "--".join([scene.name, *(re.sub(r"[^A-Za-z0-9.=_+-]+", "-", text).strip("-") for text in changes)])
    if len(name) <= LONGEST:
        return name
    from hashlib import sha256

    return f"{name[: LONGEST - 9]}-{sha256(name.encode()).hexdigest()[:8]}"


TAKEN = {"index": "the page of all scenes", "stress-table": "the page of `verify stress`"}
"""Names of pages that no scene's report may have."""


def check_free(name: str, taken: dict[str, str]) -> None:
    """Raise InputError for the name of a report that another one has."""
    if other := taken.get(name.casefold()):
        raise InputError(f"name = {name!r}: its report would take the place of {other}: give the scene another name")
