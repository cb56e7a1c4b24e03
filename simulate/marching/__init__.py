"""One run: modes, setup, schemes, status."""
