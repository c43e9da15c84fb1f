"""Cases that are hard to keep stable: what each asks, what is kept of it, and scenes drawn anew."""
