"""Growth under a tension that pulsates."""
