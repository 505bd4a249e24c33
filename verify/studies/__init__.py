"""What a scene can ask for beside figures: each study runs, and tells itself in tables, charts and facts.

Takes a scene and a workbench, gives plain values. Nothing in here prints or writes.
"""
