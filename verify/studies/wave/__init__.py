"""The driven beam: figures over sizes, envelopes, ellipses, maps."""
