"""Measure what layers cost, in processor time: one slab, whole and cut into equal layers. Run `python -m benchmarks.layers`."""

from __future__ import annotations

import sys
import time

import stickslip as ss

NUMBERS = 2800.0, 3500.0, 1e4, 1e8
"""Density (kg/m^3), wave speed (m/s), thickness (m) and normal stress (Pa)."""
LAW = ss.friction.LinearSlipWeakening(0.677, 0.525, 0.4)
DURATION, TRIES = 400.0, 5


def cost(body: ss.ElasticSlab | ss.LayeredSlab) -> tuple[float, int]:
    """Return the least processor time (s) of a run on a body, and its number of pieces."""
    problem, times = ss.Problem(body, LAW, pull_rate=0.1, initial_excess=0.0), []
    for _ in range(TRIES):
        begin = time.process_time()
        run = ss.simulate(problem, DURATION, creep_rtol=0.0, shortest_event=0.0)
        times.append(time.process_time() - begin)
    return min(times), len(run.history)


def main() -> None:
    """Print a table: the slab whole, and in 2 to 20 cells."""
    density, speed, thickness, normal = NUMBERS
    whole, pieces = cost(ss.ElasticSlab(density, speed, thickness, normal, contact_mass=1e5))
    sys.stdout.write("| body | pieces | us a piece | times the whole slab |\n| --- | --- | --- | --- |\n")
    sys.stdout.write(f"| whole | {pieces} | {1e6 * whole / pieces:.2f} | 1 |\n")
    for cells in (2, 5, 10, 20):
        body = ss.LayeredSlab([thickness / cells] * cells, [density] * cells, [speed] * cells, normal, contact_mass=1e5)
        took, pieces = cost(body)
        sys.stdout.write(f"| {cells} cells | {pieces} | {1e6 * took / pieces:.2f} | {took / whole:.1f} |\n")


if __name__ == "__main__":
    main()
