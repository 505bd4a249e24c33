"""All cases by name: each file of this folder adds its own."""

from importlib import import_module
from pkgutil import iter_modules

import verify.cases
from verify.cases.base import CASES

__all__ = ["CASES"]

for _file in iter_modules(verify.cases.__path__):
    import_module(f"verify.cases.{_file.name}")
