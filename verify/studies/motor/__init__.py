"""A slider that may leave the beam: held, free, from rest, on every field."""
