"""Steady motion with friction between wires: B and loss by the amplitude of the curvature."""
