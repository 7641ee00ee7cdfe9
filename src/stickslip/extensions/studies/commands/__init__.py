"""The commands `compare`, `analogy` and `ensemble`."""
