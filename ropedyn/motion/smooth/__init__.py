"""Motion under smooth laws, by collocation of their forces."""
