"""Motion over time as a sum over modes."""
