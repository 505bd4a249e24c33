"""A chain that is symmetric in nothing, and a slider on it."""

import pytest
from peer_cases import FORCES, FREQUENCY

from verify.peers.case import case_of, sled_of
from verify.slider import Slider


@pytest.fixture
def asymmetric_case(titanium_strip):
    return case_of(titanium_strip, 13, FORCES, FREQUENCY)


@pytest.fixture
def sled(titanium_strip):
    slider = Slider(mass=2.3e-3, mu=0.31, slope=3e3, position=0.297, speed=1.7e-4, coupling="one-way")
    return sled_of(titanium_strip, slider)
