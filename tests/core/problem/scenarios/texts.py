"""Texts of scenario files."""

GOOD = """\
title = "good"
[body]
kind = "elastic-slab"
density = 2800
wave_speed = 3500.0
thickness = "10 km"
normal_stress = "100 MPa"
[friction]
kind = "hyperbolic-rate"
static = 0.8
dynamic = 0.3
alpha = 1.0
[loading]
pull_rate = "0.05 m/year"
[initial]
excess = 0.0
[run]
duration = "12 s"
"""
"""A scenario in which nothing is wrong."""
