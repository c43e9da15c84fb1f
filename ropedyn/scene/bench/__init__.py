"""Bench tests of a piece of rope, and what is known before a measurement."""
