"""The commands `schemes` and `benchmark`."""
