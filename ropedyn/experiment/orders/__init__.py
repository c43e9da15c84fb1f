"""Which mode each measured peak is."""
