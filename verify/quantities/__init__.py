"""Named figures: what each takes, what it needs solved, what work that is, and how it is evaluated.

Takes a scene and a workbench, gives a number. Gates, claims, tables and `verify measure` ask here.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from verify.quantities.catalogue import described

__all__ = ["described"]


def __getattr__(name: str) -> Any:
    """Import the list of all quantities when it is first asked for."""
    if name not in __all__:
        raise AttributeError(f"module 'verify.quantities' has no attribute {name!r}")
    from verify.quantities import catalogue

    return getattr(catalogue, name)
