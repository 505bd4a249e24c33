"""Finite segments: rigid links and joint springs, linearised about the straight chain.

Takes a beam and a number of segments. Stands behind `segment_model`; knows neither elements nor the exact beam.
"""
