"""Every promise of the suite pushed until it breaks: rows, each with what is promised, what is measured, and where.

Takes beams, models and motions as users do, and judges them by closed forms, by counts in 50-digit arithmetic and by
what the textbook's way makes of the same; gives rows, a study for scenes and one named figure. Called by `verify
stress`, by a scene's [stress] and by the quantity `stress.share`. Rows lie in folders of the rooms that they push, and
what judges them in `references`.
"""
