"""What a measurement says of a scene."""
