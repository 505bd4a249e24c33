"""Contact in closed form, dimensionless or in SI, without a model of a beam."""
