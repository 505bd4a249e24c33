"""A slider that may leave the beam: feet on contact springs or hard landings, and the figures of the motor it makes."""
