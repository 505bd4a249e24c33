"""Common parts of the beam models: interface, factored systems, modes, fields, time bases, division into parts."""
