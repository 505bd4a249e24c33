"""A scene planned and run: every figure once, gates judged, studies done, and nothing that was not asked for.

Takes a scene, gives a plan or a result. The doors call it.
"""
