"""Files for other programs: meshes, arrays, tables, pictures and movies of a scene."""
