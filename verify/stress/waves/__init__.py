"""Rows of driven fields and of what is measured in them."""
