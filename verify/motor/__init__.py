"""Characteristics of a motor: steady states, curves, periodic orbits, sliders on a travelling wave."""
