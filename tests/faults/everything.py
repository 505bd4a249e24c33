"""Imports every module of the suite: one that is first imported under a fault would keep it for good."""

from importlib import import_module
from pkgutil import walk_packages

import verify

for found in walk_packages(verify.__path__, "verify."):
    if not found.name.endswith("__main__"):
        import_module(found.name)
