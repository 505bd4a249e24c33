"""Identification of the discretisation behind natural frequencies or mode shapes from another program."""
