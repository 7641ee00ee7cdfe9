"""Closed-form solutions for the elastic slab."""
