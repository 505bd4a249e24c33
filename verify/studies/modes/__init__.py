"""Modes over their number, over sizes and over material, beside the exact beam."""
