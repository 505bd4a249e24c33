"""Characteristics of a motor: steady states, curves, sliders on a travelling wave."""
