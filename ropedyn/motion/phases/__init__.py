"""Motion between stops and friction: linear phases in closed form, from event to event."""
