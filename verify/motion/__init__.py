"""Steps of a one-way slider on the given surface of a nonlinear chain."""
