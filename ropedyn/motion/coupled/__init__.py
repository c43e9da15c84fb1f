"""Motion of all modes of a chain, which a tension that varies, laws and dampers couple."""
