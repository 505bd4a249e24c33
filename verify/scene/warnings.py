"""Gates that accept any negative error."""

from verify.scene.model import Scene


def scene_warnings(scene: Scene) -> tuple[str, ...]:
    """A sentence for each gate without a limit of negative errors."""
    return tuple(
        f"gate {gate.id}: at_most alone accepts any negative value: give at_least too, or expect and within"
        for gate in scene.gate
        if gate.at_most is not None and gate.at_least is None
        if gate.quantity.endswith("error") and not gate.quantity.endswith(("shape_error", "curvature_error"))  # norms
    )
