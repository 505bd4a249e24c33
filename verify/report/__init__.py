"""Results as people and programs read them: HTML page, terminal, JSON, CSV, saved runs and their differences."""
