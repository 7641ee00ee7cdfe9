"""Polynomials, Radau's points, step lengths and a sine for lanes."""
