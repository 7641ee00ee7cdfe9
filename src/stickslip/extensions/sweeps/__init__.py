"""Sweeps run one scenario many times with different parameters: on a grid, for random samples, or for a list of members.

Results are kept in a store. A sweep that was killed continues from its store.
"""
