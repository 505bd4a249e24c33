"""Rows of linear beams in time, friction and sliders."""
