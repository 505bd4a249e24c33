"""Rows of what is said of models: sizes, brackets, error laws, words."""
