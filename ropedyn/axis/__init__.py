"""The axis of a rope in space: lines, arcs, helices, catenaries, polylines."""
