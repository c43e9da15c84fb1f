"""Many ropes that differ in a few numbers."""
