"""Rows of `compare`: lists of frequencies and shapes of somebody else's."""
