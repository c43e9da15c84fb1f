"""Linear motion by inversion of transfer functions on a line of complex rates."""
