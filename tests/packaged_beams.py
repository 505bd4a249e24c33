"""Beams of the packaged scenes, without the rooms that run scenes."""

import tomllib
from functools import cache
from pathlib import Path

import msgspec

import verify
from verify.beam import Beam


@cache
def packaged_beam(name):
    (path,) = Path(verify.__file__).parent.rglob(f"{name}.toml")
    return msgspec.convert(tomllib.loads(path.read_text(encoding="utf-8"))["beam"], Beam)
