"""Calculated against measured."""
