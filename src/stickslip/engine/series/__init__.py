"""Polynomials, series and step sizes."""
