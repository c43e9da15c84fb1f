"""Response to harmonic and static forces, and its derivatives."""
