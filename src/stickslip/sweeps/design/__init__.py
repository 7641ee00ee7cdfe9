"""Which members a sweep has, and what is kept of each."""
