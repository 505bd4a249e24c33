"""Contact in closed form: a rigid slider on a driving layer, a mass that leaves a surface and lands again.

Takes plain numbers without units, gives plain numbers. Quantities call it; it needs no model of a beam.
"""
