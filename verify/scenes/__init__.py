"""Scene files: what exists and what is asked of it, read, checked and turned into values; and the packaged scenes.

Takes TOML, gives a frozen scene or one sentence about what is wrong. No numerics.
"""
