"""Driven beams as waves: measures, imposed displacements, devices, unit waves superposed, two modes, where to drive.

Takes harmonic fields, gives wave measures and operating points. Measures stand behind `travelling_wave`.
"""
