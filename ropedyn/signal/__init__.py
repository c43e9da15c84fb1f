"""Arrays in, arrays out: spectra, decay, one mode fitted, likeness."""
