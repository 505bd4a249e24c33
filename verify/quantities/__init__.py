"""Named figures: what each takes, what it needs solved, what work that is, and how it is evaluated.

Takes a scene and a workbench, gives a number. Gates, claims, tables and `verify measure` ask here.
"""
