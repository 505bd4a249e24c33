"""Contact in closed form: a rigid slider on an elastic layer, feet on a wave, impacts, stick and slip on a belt.

The functions take and return dimensionless numbers or SI values; none needs a model of a beam.
"""
