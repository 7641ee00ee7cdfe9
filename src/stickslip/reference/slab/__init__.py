"""Closed forms for the elastic slab."""
