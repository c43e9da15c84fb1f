"""Numbers of a scene found from measurements."""
