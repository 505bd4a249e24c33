"""Kernels without their compiler."""

from types import FunctionType


def interpreted(module, name):
    """A kernel as Python runs it, with the parts that it calls: nothing is compiled for it."""
    known = dict(vars(module))
    for one, kernel in vars(module).items():
        if hasattr(kernel, "py_func"):
            known[one] = FunctionType(kernel.py_func.__code__, known)
    return known[name]
