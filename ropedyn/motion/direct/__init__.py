"""Motion over time by implicit steps along the chain."""
