"""Leaps over creep of a slab under a law of slip: the theory, the pattern of the load, the landing, and when to leap."""
