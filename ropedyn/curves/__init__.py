"""Measured and calculated curves over frequency, and their peaks."""
