"""The problem of a report: a table of inputs, the scene as TOML, and a drawing of the beam."""

from typing import TYPE_CHECKING, Any

import msgspec

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

EXISTS = ("beam", "drive", "slider", "motion")
"""Sections of what exists; the others say what is asked."""


class Input(msgspec.Struct, frozen=True):
    """One value that was given."""

    key: str
    value: str
    meaning: str


class Group(msgspec.Struct, frozen=True):
    """A section's inputs."""

    name: str
    rows: tuple[Input, ...]


class Problem(msgspec.Struct, frozen=True):
    """What was asked about."""

    drawing: str
    """SVG."""
    inputs: tuple[Group, ...]
    toml: str
    narrow: str = ""
    """The same drawing for a phone."""


def problem_of(scene: "Scene") -> Problem:
    """A scene drawn, tabulated and written down, as it was run."""
    from verify.report.beam_drawing import NARROW, beam_drawing
    from verify.scenes.writing import toml_text

    return Problem(beam_drawing(scene), inputs_of(scene), toml_text(stated(scene)), beam_drawing(scene, NARROW))


def inputs_of(scene: "Scene") -> tuple[Group, ...]:
    """What exists, section by section, whatever stands as it does by default left out."""
    groups = []
    for name in EXISTS:
        if (section := getattr(scene, name)) is not None:
            groups += _groups(name, section)
    return tuple(groups)


def _groups(name: str, section: msgspec.Struct) -> list[Group]:
    """A section and the tables within it, one after the other."""
    from verify.scenes.described import meanings

    told = meanings(type(section))
    rows, inner = [], []
    for key, value in _given(section).items():
        if isinstance(value, msgspec.Struct):
            inner += _groups(f"{name}.{key}", value)
        elif isinstance(value, tuple) and value and isinstance(value[0], msgspec.Struct):
            inner += [group for i, one in enumerate(value) for group in _groups(f"{name}.{key}[{i}]", one)]
        else:
            rows.append(Input(key, _written(value), told.get(key, "")))
    return [Group(name, tuple(rows)), *inner]


def _written(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.10g}"
    return ", ".join(map(_written, value)) if isinstance(value, tuple) else str(value)


def _given(section: msgspec.Struct) -> dict[str, Any]:
    """Fields of a struct that do not stand as by default."""
    found, values = {}, msgspec.structs.asdict(section)  # as given: a beam answers with what follows from its shape
    for field in msgspec.structs.fields(section):
        value = values[field.name]
        if value is None or (field.default is not msgspec.NODEFAULT and value == field.default and not field.required):
            continue
        found[field.encode_name] = value
    return found


def stated(value: Any) -> Any:
    """A scene as plain tables, whatever stands as it does by default left out."""
    if isinstance(value, msgspec.Struct):
        return {key: stated(one) for key, one in _given(value).items()}
    if isinstance(value, tuple | list):
        return [stated(one) for one in value]
    return {key: stated(one) for key, one in value.items()} if isinstance(value, dict) else value
