"""Least squares between a scene and what was measured."""
