"""Friction and normal laws, one file a friction law, and the solver of the contact forces of a step."""
