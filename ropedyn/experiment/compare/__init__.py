"""Calculated against measured, and one calculation against another."""
