"""The own files of newcomers of seven trades, as their machines write them, each made without the package's engine.

Every file has a truth in closed form or from scipy, with which `benchmarks.ways_through` compares what the commands answer.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Floats = NDArray[np.float64]
Rates = tuple[tuple[float, float], ...]
"""Times (s), and the rates (m/s) from each on."""
ROCK = {"reference": 0.62, "a": 0.008, "b": 0.0125, "distance": 15e-6, "stiffness": 60e6}
"""The truth of the record of the rig: a rock under 50 kN, rate 10 um/s, with the stiffness in N/m."""
DRIFT = 2.0
"""Friction that the rig loses for each metre of slip."""
ROSIN = {"static": 0.8, "dynamic": 0.35, "alpha": 12.0}
SLIDE = {"static": 0.21, "dynamic": 0.13, "alpha": 35.0}
"""The truths of the measured points: hyperbolic in the slip rate (alpha in s/m)."""
STEPS: Rates = ((0.0, 1e-5), (15.0, 1e-4), (25.0, 1e-5), (40.0, 3e-5), (50.0, 1e-5))
"""When (s) the rig changes its rate, and to which (m/s)."""


def slider(
    steps: tuple[tuple[float, float], ...], lasts: float, rate: float, servo: float
) -> tuple[Floats, Floats, Floats, Floats]:
    """Return time, friction, load point (m) and slip (m) of a slider without inertia, under rate-and-state friction (ageing).

    Its load point steps from rate to rate with the lag `servo` (s); `rate` is that of the samples (1/s).
    """
    normal, start = 50e3, steps[0][1]

    def change(_: float, y: Floats, wanted: float) -> list[float]:
        friction, log_state, _slip, _moved, pull = y
        exponent = ROCK["reference"] + ROCK["b"] * (math.log(1e-5 / ROCK["distance"]) + log_state)
        slips = 2e-5 * math.sinh(friction / ROCK["a"]) * math.exp(-exponent / ROCK["a"])
        stiffness = ROCK["stiffness"] / normal
        return [stiffness * (pull - slips), math.exp(-log_state) - slips / ROCK["distance"], slips, pull, (wanted - pull) / servo]

    clock = np.arange(round(lasts * rate)) / rate
    steady = ROCK["reference"] + (ROCK["a"] - ROCK["b"]) * math.log(start / 1e-5)
    state, parts = np.array([steady, math.log(ROCK["distance"] / start), 0.0, 0.0, start]), []
    for (begin, wanted), end in zip(steps, [*(at for at, _ in steps[1:]), lasts], strict=True):
        inside = clock[(clock >= begin) & (clock < end)]
        found = solve_ivp(
            change,
            (begin, end),
            state,
            "LSODA",
            args=(wanted,),
            t_eval=np.union1d(inside, end),
            rtol=1e-9,
            atol=[1e-9, 1e-9, 1e-12, 1e-12, 1e-14],
        )
        state = found.y[:, -1]
        parts.append(found.y[:4, : len(inside)])
    friction, _, slip, moved = np.hstack(parts)
    return clock, friction, moved, slip


def table(file: Path, headings: str, columns: list[Floats], form: str = "%.6f", between: str = ",", before: str = "") -> None:
    """Write columns under headings that are parted as the columns are."""
    rows = (between.join(form % one for one in row) for row in zip(*columns, strict=True))
    file.write_text(before + "\n".join([headings, *rows]) + "\n", encoding="utf-8")


def rig(file: Path) -> None:
    """A double-direct-shear record at 50 Hz: friction falls with slip, the servo lags by 80 ms, the normal stress wobbles."""
    time, friction, moved, slip = slider(STEPS, 60.0, 50.0, 0.08)
    random = np.random.default_rng(1)
    normal = 10.0 * (1.0 + 3e-4 * np.sin(2.0 * math.pi * time / 3.7))
    shear = (friction - DRIFT * slip + 2e-4 * random.standard_normal(len(time))) * normal
    table(file, "Time (s),Shear stress (MPa),Normal stress (MPa),Vert_disp (micron)", [time, shear, normal, 1e6 * moved])


def lab_view(file: Path) -> None:
    """A measurement file as LabVIEW writes it, with a decimal comma and X_Columns No, of the same slider without drift."""
    time, friction, moved, _ = slider(STEPS, 60.0, 20.0, 0.02)
    friction = friction + 2e-4 * np.random.default_rng(2).standard_normal(len(time))
    head = [
        *("LabVIEW Measurement", "Writer_Version\t2", "Reader_Version\t2", "Separator\tTab", "Decimal_Separator\t,"),
        *("Multi_Headings\tYes", "X_Columns\tNo", "Time_Pref\tRelative", "Operator\tstudent", "Date\t2024/05/02"),
        *("Time\t10:15:02,1234567", "***End_of_Header***", "", f"Channels\t2\t\t\nSamples\t{len(time)}\t{len(time)}\t"),
        *("Date\t2024/05/02\t2024/05/02\t", "Time\t10:15:02,1234567\t10:15:02,1234567\t", "Y_Unit_Label\t\tmm\t"),
        *("X_Dimension\tTime\tTime\t", "X0\t0,0000000000000000E+0\t0,0000000000000000E+0\t", "Delta_X\t0,050000\t0,050000\t"),
        *("***End_of_Header***\t\t\t", "X_Value\tFriction\tLoad point (mm)\tComment"),
    ]
    rows = [f"\t{one:.6f}\t{1e3 * x:.6f}\t".replace(".", ",") for one, x in zip(friction, moved, strict=True)]
    file.write_text("\r\n".join([*head, *rows]) + "\r\n", encoding="cp1252")


def ground(file: Path) -> None:
    """An accelerogram at 100 Hz in g: three half-waves of 0.3 g towards the valley and back, with rest before and after."""
    time = np.arange(601) / 100.0
    shaken = np.where((time >= 1.0) & (time <= 4.0), 0.3 * np.sin(2.0 * math.pi * (time - 1.0)), 0.0)
    table(file, "Time [s];Acc [g]", [time, shaken], "%.5f", ";", "Station XYZ;EW component\n")


def slope(file: Path) -> None:
    """A scenario of a block on a slope of 15 degrees that yields at 0.1 g, with the accelerogram as its ground."""
    file.write_text(
        """title = "My slope"
[body]
kind = "spring-block"
mass = 38000
stiffness = 4.0
normal_force = 359955
[friction]
kind = "coulomb"
static = 0.3715
dynamic = 0.3715
[loading]
one_way = true
[loading.ground_acceleration]
kind = "piecewise-linear"
file = "quake.csv"
[initial]
load = 96449.6
[run]
duration = "8 s"
""",
        encoding="utf-8",
    )


def newmark() -> float:
    """Return the slip (m) of that block under that record, by summation in small steps, as in Newmark 1965; it slides one way."""
    step, gravity, yields = 1e-5, 9.80665, (0.3715 * 359955 - 96449.6) / 38000 / 9.80665
    time = np.arange(0.0, 6.0, step)
    samples = np.arange(601) / 100.0
    shaken = np.where((samples >= 1.0) & (samples <= 4.0), 0.3 * np.sin(2.0 * math.pi * (samples - 1.0)), 0.0).round(5)
    excess = (-np.interp(time, samples, shaken) - yields) * gravity
    rate = slip = 0.0
    for one in excess:
        rate = max(rate + float(one) * step, 0.0)
        slip += rate * step
    return slip


def measured(file: Path, truth: dict[str, float], heading: str, unit: float, between: str) -> None:
    """Points of friction against the slip rate, as a shop or an acoustician measures them; `unit` is that of the heading (m/s)."""
    rate = np.geomspace(1e-4, 3.0, 40)
    friction = truth["dynamic"] + (truth["static"] - truth["dynamic"]) / (1.0 + truth["alpha"] * rate)
    friction = friction + 5e-4 * np.random.default_rng(3).standard_normal(len(rate))
    table(file, f"{heading}{between}COF", [rate / unit, friction], "%.5f", between)


def floor(file: Path) -> None:
    """The log of a drill floor at 10 Hz: surface torque in kft.lbf, rpm, and weight in klbf, of the bundled scenario drill-string.

    The drive goes from 180 to 150, 200 and 165 rpm within 2 s each, which no bit under this weight answers by sticking. The
    string is followed along its characteristics, with the inertia of the collars in the middle of each step.
    """
    impedance, inertia, pressed = polar_moment() * math.sqrt(7850.0 * 61e9), 305.0, 97.347e3 * 0.155575
    parts = 640
    step = 1770.0 / math.sqrt(61e9 / 7850.0) / parts
    clock = np.arange(0.0, 400.0, step)
    drive = np.interp(clock, [100, 102, 200, 202, 300, 302], [180, 150, 150, 200, 200, 165]) * math.pi / 30.0

    def resists(rate: float) -> float:
        return pressed * (0.5 + 0.3 * math.exp(-0.9 * rate) + 0.0033 * rate)

    rate = float(drive[0])
    up = np.full(parts, 0.5 * (rate - resists(rate) / impedance))  # half-waves on their way to the drive, the oldest next
    down = np.full(parts, rate - up[0])
    surface = np.empty(len(clock))
    for i, turned in enumerate(drive.tolist()):
        at = i % parts
        arrived, came = down[at], up[at]
        surface[i] = impedance * (turned - 2.0 * came)
        down[at] = turned - came
        half = rate + 0.5 * step * (impedance * (2.0 * arrived - rate) - resists(rate)) / inertia
        after = rate + step * (impedance * (2.0 * arrived - half) - resists(half)) / inertia
        up[at] = 0.5 * (rate + after) - arrived
        rate = after
    time = np.arange(0.0, 399.0, 0.1)
    torque, turned = np.interp(time, clock, surface), np.interp(time, clock, drive) * 30.0 / math.pi
    torque = torque + 20.0 * np.random.default_rng(4).standard_normal(len(time))
    columns = [time, torque / 1355.8179483314004, turned, np.full(len(time), 97.347 / 4.4482216152605)]
    table(file, "TIME (s),STOR (kft.lbf),SRPM (rpm),SWOB (klbf)", columns, "%.4f")


def polar_moment() -> float:
    """Return the polar moment (m^4) of the pipe of drill-string."""
    return math.pi / 32.0 * (0.146529**4 - 0.123024**4)


FILES: dict[str, Callable[[Path], None]] = {
    "shear.csv": rig,
    "lab.lvm": lab_view,
    "quake.csv": ground,
    "slope.toml": slope,
    "axis.txt": lambda file: measured(file, SLIDE, "Speed [mm/min]", 1e-3 / 60.0, "\t"),
    "rosin.csv": lambda file: measured(file, ROSIN, "v (cm/s)", 1e-2, ","),
    "floor.csv": floor,
}
"""Writers by the name of the file."""
