"""Recorded motion over time, and what it shows."""
