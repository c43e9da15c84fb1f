"""What a user describes: the rope, what holds and loads it, how it is damped."""
