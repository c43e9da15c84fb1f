"""Parts that stand on the rope or change stretches of it."""
