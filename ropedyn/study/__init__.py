"""Many answers beside each other: prices of accuracy and effects, sweeps, the 2015 study."""
