"""Numerical schemes for the slab on a grid, beside which the exact solution shows what a scheme does: `ss.studies.schemes(...)`.

A scheme is one small class. It says how the body moves in one step of time (`contract.Scheme`); the contact is the same for all
schemes (`run.GridContact`). `run.SCHEMES` lists them by name.
"""
