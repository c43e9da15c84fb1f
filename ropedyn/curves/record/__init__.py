"""Records over time, and what they tell."""
