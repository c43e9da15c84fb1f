"""Where and how long to measure."""
