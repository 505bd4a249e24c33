"""Beams, cross-sections, attachments, devices and sliders as frozen values in SI units."""
