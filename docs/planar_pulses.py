"""Count pulses in the middle of a fault of finite length, for the page on faults in 2D and 3D: minutes, so that no test runs it.

python docs/planar_pulses.py
"""

from __future__ import annotations

import numpy as np

import stickslip as ss

GRIDS = ((0.125, 1024), (0.125, 2048), (0.25, 2048), (0.5, 4096), (1.0, 4096), (1.0, 8192), (2.0, 8192))
"""Length of the fault over the thickness of the slab, and number of nodes along 1.25 of its length."""


def main() -> None:
    """Print a line for each grid."""
    problem = ss.scenarios["fig5-slab-reconstructed"].problem
    thickness, trip = problem.body.thickness, problem.round_trip_time  # type: ignore[attr-defined]
    for ratio, nodes in GRIDS:
        length = ratio * thickness
        fault = ss.PlanarSlab(problem, nodes=nodes, length=1.25 * length, barrier=lambda y, half=0.5 * length: np.abs(y) > half)
        run = ss.simulate(fault, 0.9999 * trip, frames=1500)
        inside = run.pulses[np.abs(fault.y) <= 0.5 * length]
        print(
            f"L = {ratio:g} h, {fault.spacing[0]:.2f} m between nodes, {run.nodes_per_process_zone:.1f} in a process zone:"
            f" {run.pulses[nodes // 2]} in the middle, {inside.min()} to {inside.max()} elsewhere"
        )


if __name__ == "__main__":
    main()
