"""Piezoelectric actuators: materials, bars, stacks, transducers, patches; shunts; actuators on a beam."""
