"""Finite segments: rigid links and joint springs, linearised about the straight chain.

Parts of `segment_model`; independent of elements and of the exact beam.
"""
