"""A slab whose driver changes twice, as a scenario."""

SCENARIO = """
[body]
kind = "elastic-slab"
density = 2800
wave_speed = 3500
thickness = 1000
normal_stress = 1e8
[friction]
kind = "coulomb"
static = 0.6
dynamic = 0.5
[loading]
pull_rate = 0.4
far_stress = 0
[loading.driver_reflection]
kind = "steps"
times = [0, "3 s", "6 s"]
values = [-1, 1, -0.5]
[initial]
load = 5.9e7
[run]
duration = "12 s"
"""
