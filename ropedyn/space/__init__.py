"""Ropes on an axis in space: all six coordinates at once, uniform pieces exact."""
