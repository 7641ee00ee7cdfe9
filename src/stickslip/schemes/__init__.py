"""Numerical schemes for the slab on a grid, beside which the exact solution shows what a scheme does: `ss.studies.schemes(...)`.

A scheme is one small file. It says how the body moves in one step of time (`contract.Scheme`); the contact is the same for all
schemes (`contact.GridContact`). `registry.SCHEMES` lists them by name.
"""
