"""Periodic motion by harmonic balance."""
