"""Rows of where answers end, where another way is taken, and what size costs."""
