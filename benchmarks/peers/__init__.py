"""The same chain in other engines, each by its own interface. `pip install '.[peers]'` brings them."""
