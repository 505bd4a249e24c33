"""Rows of sliders that may leave their beam."""
