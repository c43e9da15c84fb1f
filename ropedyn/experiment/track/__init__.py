"""Tension over time, from many records."""
