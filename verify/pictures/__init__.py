"""Pictures of a scene: modes, the wave, the slider on it, a chain rolled up; as still or moving files.

Takes a scene, gives a `Picture`: solids, lines and words in plain arrays, the same for every way of drawing. Drawn
solid by pyvista in a process of its own, because VTK ends the process that finds no OpenGL, or flat by Pillow. The
doors call it. It stands above `run`, and loads Pillow only where something is drawn.
"""
