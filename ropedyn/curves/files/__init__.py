"""Files of curves: universal files and text in columns."""
