"""What a scene gives to other tools, in files that they read: meshes, modes, fields, motions, tables.

Takes a scene and what is wanted of it; gives a sheet (points, cells, arrays, a series) and files of it, by meshio where
a mesh is wanted. Reads meshes as well, with somebody's mode shapes on them. The doors call it. It stands above `run`,
whose tables it writes, and loads meshio only where a mesh is written or read.
"""
