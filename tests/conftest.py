"""Beams that several tests share, and settings of the libraries."""

import os

import pytest
from hypothesis import HealthCheck, settings

from verify.problem.beam import Beam

pytest_plugins = ["pytester"]

for library in ("OPENBLAS", "MKL", "OMP"):  # matrices are small, and workers share the cores
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

settings.register_profile("any machine", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("any machine")  # how long drawing takes is the machine's own affair


@pytest.fixture
def paper_beam():
    return Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)


@pytest.fixture
def titanium_strip():
    return Beam(length=0.73, width=0.031, thickness=0.0023, youngs_modulus=113e9, density=4470.0)
