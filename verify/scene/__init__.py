"""Scenes: what exists, what is published about it, which studies and gates run on it."""
