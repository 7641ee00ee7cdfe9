"""Draw docs/figures/scheme-pulses.png: pulses on a grid against the mesh, for a slab whose load is its largest friction.

python docs/scheme_pulses.py

The exact solution makes one pulse in a round trip of the waves, whatever the numbers. A pulse is counted for the first period of
friction and for every further maximum of friction that the slip passes; ringing on a grid is not counted.
"""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib import pyplot as plt

import stickslip as ss
from stickslip.extensions.schemes.run import SCHEMES, run_scheme
from stickslip.figures.style import GREY, LINE_COLOURS

FIGURE = Path(__file__).with_name("figures") / "scheme-pulses.png"
CASES = ((5.0, 1e-2), (50.0, 1e-3))
"""Wavenumber (1/m), and by how much (m) the start lies beyond the friction maximum."""
MESHES = (4.0, 3.0, 2.5, 2.0, 1.7, 1.5, 1.45, 1.35, 1.2, 1.0, 0.85, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2)
"""Cells, as Gamma = S amplitude wavenumber dx / G."""
TICKS = (0.2, 0.5, 1.0, 2.0, 4.0)
RUNS = (
    ("central-differences", 0.5),
    ("newmark", 0.5),
    ("mass-redistribution", 0.5),
    ("backward-euler", 0.5),
    ("characteristics", 1.0),
    ("sbp4", 0.5),
)
"""Schemes, with their Courant numbers."""
SMALLEST_DAMPING = 1.193
"""Damping of the pendulum phi'' + damping phi' + sin phi = 1 above which it does not roll on: see
tests/extensions/schemes/test_pulses.py."""
SIDE = (5.0, 0.1, 0.95)
"""A side test: wavenumber (1/m), start beyond the maximum (m), and load beyond the mean friction as a share of S a."""
MASS = "exact, mass rho dx/2"


def problem(wavenumber: float, beyond: float, load: float = 1.0) -> ss.Problem:
    """Return the slab started beyond the friction maximum, under a driver at rest; its load is exactly the maximum, or a share."""
    law = ss.friction.SinusoidalSlip(1.0, 0.5, wavenumber)
    slab = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
    excess = slab.normal_stress * law.amplitude * (load - math.cos(wavenumber * beyond))
    return ss.Problem(slab, law, initial_slip=0.5 * math.pi / wavenumber + beyond, initial_excess=excess)


def pulses(slip: float, wavenumber: float, beyond: float) -> int:
    """Return how many periods of friction a slip (m) has entered; the first is entered at the start.

    A slip that ends within a hundredth of a period beyond a maximum has come to rest on it.
    """
    return 1 + max(math.floor((slip + beyond) * wavenumber / (2.0 * math.pi) - 0.01), 0)


def counts(wavenumber: float, beyond: float) -> dict[str, list[int]]:
    """Return the pulses in one round trip for each mesh: of each scheme, and of the exact contact with the mass of its node."""
    given = problem(wavenumber, beyond)
    slab = given.body
    assert isinstance(slab, ss.ElasticSlab)
    found: dict[str, list[int]] = {name: [] for name, _ in RUNS} | {MASS: []}
    for gamma in MESHES:
        cells = round(slab.thickness * slab.normal_stress * 0.5 * wavenumber / (slab.shear_modulus * gamma))
        for name, courant in RUNS:
            series = run_scheme(given, slab.two_way_time, SCHEMES[name], cells, courant=courant)
            end = float(np.interp(slab.two_way_time, series.time, series.slip))
            found[name].append(pulses(end, wavenumber, beyond))
        heavy = replace(given, body=replace(slab, contact_mass=0.5 * slab.density * slab.thickness / cells))
        run = ss.simulate(heavy, slab.two_way_time)
        found[MASS].append(pulses(float(run.slip(slab.two_way_time)) - given.initial_slip, wavenumber, beyond))
    return found


def print_side_test() -> None:
    """Print the pulses of the two schemes with the most of them, for a load below the friction maximum."""
    wavenumber, beyond, _ = SIDE
    given = problem(*SIDE)
    slab = given.body
    assert isinstance(slab, ss.ElasticSlab)
    print(f"wavenumber {wavenumber:g} /m, {beyond:g} m beyond the maximum, load {100 * (1 - SIDE[2]):.0f} % of S a below it")
    for name in ("central-differences", "newmark"):
        found = []
        for gamma in MESHES:
            cells = round(slab.thickness * slab.normal_stress * 0.5 * wavenumber / (slab.shear_modulus * gamma))
            series = run_scheme(given, slab.two_way_time, SCHEMES[name], cells, courant=0.5)
            found.append(pulses(float(np.interp(slab.two_way_time, series.time, series.slip)), wavenumber, beyond))
        print(f"{name:24}", *(f"{value:5d}" for value in found), flush=True)


def main() -> None:
    """Measure, print the table, and draw."""
    threshold = 2.0 / SMALLEST_DAMPING**2
    figure, panels = plt.subplots(1, 2, figsize=(8.0, 4.2), sharey=True, layout="constrained")
    for panel, (wavenumber, beyond) in zip(panels, CASES, strict=True):
        found = counts(wavenumber, beyond)
        print(f"wavenumber {wavenumber:g} /m")
        print(f"{'Gamma':24}", *(f"{gamma:5g}" for gamma in MESHES))
        for i, (name, values) in enumerate(found.items()):
            print(f"{name:24}", *(f"{value:5d}" for value in values), flush=True)
            heavy = name == MASS
            style = {"color": "black", "linestyle": "--"} if heavy else {"color": LINE_COLOURS[i], "linestyle": "-"}
            panel.plot(MESHES, values, marker="s" if heavy else "o", markersize=3.5, label=name, **style)
        panel.axvline(threshold, color=GREY, linewidth=0.9, linestyle=":")
        panel.set(
            xscale="log",
            yscale="log",
            xticks=TICKS,
            xticklabels=[f"{tick:g}" for tick in TICKS],
            xlabel=r"mesh $\Gamma = S a \omega\, \Delta x / G$",
        )
        panel.minorticks_off()
        panel.set_title(rf"$\omega$ = {wavenumber:g} /m, $u_0 = u_c$ + {1e3 * beyond:g} mm", fontsize=10)
    print_side_test()
    panels[0].set_ylabel("pulses in one round trip of the waves")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    figure.savefig(FIGURE, dpi=150)


if __name__ == "__main__":
    main()
