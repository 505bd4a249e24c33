"""What a scene may hold, told to people and to editors, from the types that read it."""

import re
from pathlib import Path

import pytest

from verify.errors import InputError
from verify.quantities.catalogue import QUANTITIES
from verify.scenes.described import TOP, keys_of, sections
from verify.scenes.scene import STARTER, packaged_scenes, scene_path
from verify.scenes.schema import scene_schema, section_schema
from verify.scenes.toml import read_toml

SCHEMA = scene_schema(QUANTITIES)
SAID = {"$schema", "$defs", "title", "description", "default"}
"""Words of a schema that refuse nothing."""
TYPES = {"object": dict, "array": list, "string": str, "boolean": bool, "integer": int, "number": (int, float)}


def refusals(data, schema, where="scene"):
    """What draft 7 refuses, by the words of it that these schemas use; another word is a failure of this check."""
    if "$ref" in schema:
        return refusals(data, SCHEMA["$defs"][schema["$ref"].removeprefix("#/$defs/")], where)
    found = []
    for word, told in schema.items():
        if word not in SAID:
            found += CHECKS[word](data, told, schema, where)
    return found


def of_type(data, told, schema, where):
    right = isinstance(data, TYPES[told]) and (told == "boolean" or not isinstance(data, bool))
    return [] if right else [f"{where}: {data!r} is no {told}"]


def in_properties(data, told, schema, where):
    return [r for key in data if key in told for r in refusals(data[key], told[key], f"{where}.{key}")]


def no_others(data, told, schema, where):
    assert told is False
    return [f"{where}.{key} is unknown" for key in data if key not in schema["properties"]]


def in_items(data, told, schema, where):
    entries = told if isinstance(told, list) else [told] * len(data)
    return [r for one, kind in zip(data, entries, strict=False) for r in refusals(one, kind, where)]


def when(wrong):
    return lambda data, told, schema, where: [f"{where}: {data!r} against {told!r}"] if wrong(data, told) else []


CHECKS = {
    "type": of_type,
    "properties": in_properties,
    "additionalProperties": no_others,
    "items": in_items,
    "additionalItems": when(lambda data, told: told is not False),
    "required": when(lambda data, told: set(told) - set(data)),
    "enum": when(lambda data, told: data not in told),
    "pattern": when(lambda data, told: not re.search(told, data)),
    "minLength": when(lambda data, told: len(data) < told),
    "maxLength": when(lambda data, told: len(data) > told),
    "minItems": when(lambda data, told: len(data) < told),
    "maxItems": when(lambda data, told: len(data) > told),
    "minimum": when(lambda data, told: data < told),
    "maximum": when(lambda data, told: data > told),
    "exclusiveMinimum": when(lambda data, told: data <= told),
    "exclusiveMaximum": when(lambda data, told: data >= told),
    "anyOf": lambda data, told, schema, where: (
        [] if any(not refusals(data, one, where) for one in told) else [f"{where}: {data!r} is none of them"]
    ),
    "allOf": lambda data, told, schema, where: [r for one in told for r in refusals(data, one, where)],
}


@pytest.mark.parametrize("scene", [*packaged_scenes(), str(STARTER)], ids=lambda scene: Path(scene).stem)
def test_the_schema_takes_every_scene_that_is_packaged(scene):
    assert refusals(read_toml(scene_path(scene)), SCHEMA) == []


@pytest.mark.parametrize(
    ("change", "refusal"),
    [
        (lambda data: data["beam"].update(lenght=0.7), "scene.beam.lenght is unknown"),
        (lambda data: data.update(baem={}), "scene.baem is unknown"),
        (lambda data: data["gate"][3].update(withn=0.1), "scene.gate.withn is unknown"),
        (lambda data: data["drive"]["force"][1].update(phase=3.0), "scene.drive.force.phase is unknown"),
        (lambda data: data["beam"].update(supports=["pinned"]), "scene.beam.supports: ['pinned'] against 2"),
        (lambda data: data["beam"].update(supports=["pinned", "fixed"]), "scene.beam.supports: 'fixed' against"),
        (lambda data: data["gate"][2].update(quantity="mode.freqency"), "scene.gate.quantity: 'mode.freqency' against"),
        (lambda data: data["spectrum"].update(modes=0), "scene.spectrum.modes: 0 against 1"),
        (lambda data: data["gate"][5].update(expect="4467"), "scene.gate.expect: '4467' is none of them"),
        (lambda data: data["beam"].pop("length"), "scene.beam: {'width'"),
    ],
)
def test_the_schema_refuses_what_a_scene_cannot_hold(change, refusal):
    data = read_toml(scene_path("paper"))
    change(data)
    (found,) = refusals(data, SCHEMA)
    assert found.startswith(refusal)


def test_the_schema_says_what_each_key_means_and_has_no_null_which_toml_has_not():
    tables = {"Scene": SCHEMA, **SCHEMA["$defs"]}
    silent = [(n, key) for n, t in tables.items() for key, told in t["properties"].items() if "description" not in told]
    assert silent == []
    assert SCHEMA["$defs"]["Beam"]["properties"]["tension"]["description"].startswith("Axial force, newton")
    assert "null" not in str(SCHEMA)


def test_a_section_has_a_schema_of_its_own_beside_what_it_refers_to():
    drive = section_schema("drive")
    assert set(drive["properties"]) == {"frequency_hz", "kind", "force", "device"}
    assert drive["$defs"]["SceneForce"]["required"] == ["position"]


def test_every_section_tells_its_keys_and_what_each_means():
    assert {
        TOP,
        "beam",
        "beam.section",
        "beam.mass",
        "beam.spring",
        "drive.force",
        "drive.device",
        "gate.expect",
    } <= set(sections())
    silent = [(name, key.key) for name in sections() for key in keys_of(name) if not key.meaning]
    assert silent == []


def test_a_key_has_its_type_its_default_and_its_unit():
    keys = {key.key: key for key in keys_of("motion")}
    assert (keys["duration"].type, keys["duration"].default, keys["duration"].meaning) == ("number", 1e-3, "Seconds.")
    assert keys["samples"].type == "whole number, at least 2, at most 100000"
    assert keys["start"].type == "rest | steady"
    force = {key.key: key for key in keys_of("drive.force")}
    assert (force["position"].required, force["amplitude"].required) == (True, False)
    assert {key.key: key for key in keys_of("beam")}["supports"].type == "list of 2: pinned | clamped | free | guided"


def test_a_section_that_there_is_not_is_named_with_the_nearest():
    with pytest.raises(InputError, match=r"section = 'beam\.sprng' is not known: did you mean 'beam\.spring'"):
        keys_of("beam.sprng")
