"""Bench tests of a piece of rope: bending and torsion."""
