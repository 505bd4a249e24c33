"""A slider that stays on the beam: its run on every model, and run time against error."""
