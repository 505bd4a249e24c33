"""Numerical stress checks: errors and costs along one parameter, up to where they exceed their tolerance."""
