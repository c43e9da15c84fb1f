"""What peaks tell of a tension whose ends, mass and length are not known exactly."""
