"""Natural frequencies, shapes, their derivatives and their mesh error."""
