"""Rows of what is refused, each by its sentence."""
