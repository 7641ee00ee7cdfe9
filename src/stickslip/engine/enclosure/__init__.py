"""Intervals proven to hold all values of a friction law and of its derivatives while slip and slip rate stay in a box."""
