"""Identification of friction and of a beam from measured data, with intervals of the parameters."""
