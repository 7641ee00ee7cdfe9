"""Layers on moving ground, behind a driver that changes or is a machine, as scenarios."""

LAYERS = """
[body]
kind = "layered-slab"
thickness = ["1 km", "2 km"]
density = [2800, 2800]
wave_speed = [1750, 3500]
normal_stress = "100 MPa"
{machine}
[friction]
kind = "coulomb"
static = 0.6
dynamic = 0.5
[loading]
pull_rate = 0.2
{loading}
[initial]
load = "59 MPa"
[run]
duration = "12 s"
"""
FREED = """far_stress = 0
[loading.driver_reflection]
kind = "steps"
times = [0, "3 s", "6 s"]
values = [-1, 1, -0.5]
"""
SHAKEN = """
[loading.ground_velocity]
kind = "sinusoidal"
mean = 0
amplitude = 0.1
period = "2 s"
"""
MACHINE = """driver_impedance = "5 MPa s/m"
driver_integral_gain = "1 MPa/m"
"""
DRIVEN = {
    "driver": ({"loading": FREED}, "loading.driver_reflection.times[1]=0.5 s"),
    "ground": ({"loading": SHAKEN}, "loading.ground_velocity.amplitude=0.2"),
    "machine": ({"machine": MACHINE}, "driver_integral_gain=2e6"),
}
"""Lines of a scenario of layers, and what --set changes."""
