"""Rows of natural frequencies and shapes: sizes, scales, bodies, stacks, what stands between a beam and its modes."""
