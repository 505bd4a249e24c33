"""Driven beams as waves: measures, imposed displacements, unit waves superposed, where to drive.

Takes harmonic fields, gives wave measures and operating points. Measures stand behind `travelling_wave`.
"""
