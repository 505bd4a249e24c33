"""How linear a chain of rigid links is."""
