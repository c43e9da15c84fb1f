"""Complex modes of damped motion."""
