"""What `--set` makes of a scene's tables beside the one value that it names."""

from collections.abc import Iterable
from typing import Any

from verify.options import OF_THE_CHAIN
from verify.slider import OF_ONE_LAW


def set_twice(overrides: Iterable[str]) -> list[str]:
    """A sentence for every key that is set more than once."""
    values: dict[str, list[str]] = {}
    for text in overrides:
        key, _, value = text.partition("=")
        values.setdefault(key.strip(), []).append(value.strip())
    return [f"{key} is set to {' and to '.join(each)}: set it once" for key, each in values.items() if len(each) > 1]


def forget_what_is_no_more(data: dict[str, Any], overrides: Iterable[str]) -> None:
    """Leave out, in place, what belongs to what was set to something else.

    That are references of expectations, what a slider has of another law, what a motor has of the nonlinear chain.
    """
    keys = {text.partition("=")[0].strip() for text in overrides}
    _forget_references(data, keys)
    _forget_other_law(data, keys)
    _forget_the_chain(data, keys)


def _forget_references(data: dict[str, Any], keys: set[str]) -> None:
    """What gates say of references to expectations that were set, unless it was set as well."""
    gates = data.get("gate") if any(key.startswith("gate.") for key in keys) else None
    for i, gate in enumerate(gates if isinstance(gates, list) else ()):
        if not isinstance(gate, dict):
            continue
        names = (f"gate.{i}", f"gate.{gate.get('id', i)}")
        set_here = {key.rpartition(".")[2] for key in keys if key.rpartition(".")[0] in names}
        if set_here & {"expect", "at_least", "at_most"} and "reference" not in set_here:
            for name in ("reference", "uncertainty", "source"):
                gate.pop(name, None)


def _forget_other_law(data: dict[str, Any], keys: set[str]) -> None:
    """What a slider has of another law than the one that was set, unless it was set as well."""
    slider = data.get("slider")
    if "slider.law" in keys and isinstance(slider, dict):
        for law, name in OF_ONE_LAW.items():
            if slider["law"] != law and f"slider.{name}" not in keys:
                slider.pop(name, None)


def _forget_the_chain(data: dict[str, Any], keys: set[str]) -> None:
    """What a motor has of the nonlinear chain where that was set out of its models, unless it was set as well."""
    motor = data.get("motor")
    if "motor.models" not in keys or not isinstance(motor, dict) or not isinstance(motor["models"], list):
        return
    for name in OF_THE_CHAIN:
        if "chain" not in motor["models"] and f"motor.{name}" not in keys:
            motor.pop(name, None)
