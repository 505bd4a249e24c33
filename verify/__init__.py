"""Finite segments against finite elements against exact beam theory: how far to trust them, at what cost."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from verify.beam import Beam, PointForce
    from verify.errors import InputError
    from verify.run.runner import run_scene
    from verify.scenes.scene import load_scene
    from verify.slider import Slider

__all__ = ["Beam", "InputError", "PointForce", "Slider", "__version__", "load_scene", "run_scene"]
__version__ = "0.1.0"

_HOME = {
    "Beam": "verify.beam",
    "InputError": "verify.errors",
    "PointForce": "verify.beam",
    "Slider": "verify.slider",
    "load_scene": "verify.scenes.scene",
    "run_scene": "verify.run.runner",
}


def __getattr__(name: str) -> Any:
    """Import a public name from its home when it is first asked for, so that `import verify` costs nothing."""
    if name not in _HOME:
        raise AttributeError(f"module 'verify' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(_HOME[name]), name)
