"""Another code: velocities at nodes, stresses between them, viscous damping of the grid, friction with traction at split nodes.

It is written as many codes of ruptures are, uses numpy only, and knows nothing of the package. `python staggered_grid.py` makes
staggered_grid.csv: the slab of the paper's Fig. 4 under a load that passes both folds.
"""

from pathlib import Path

import numpy as np

RHO, C, H, S = 2800.0, 3500.0, 1e4, 1e8  # density, wave speed, thickness, normal stress
STATIC, DYNAMIC, ALPHA = 0.8, 0.3, 1.0  # friction mu = dynamic + (static - dynamic) / (1 + alpha v)
STRESS, PULL, DURATION = 60e6, 2.6, 5.7  # initial stress, which the far side keeps; velocity of the far side at t = 0; s
CELLS, COURANT, DAMPING = 200, 0.4, 0.3  # damping: viscosity of the grid in steps of time
FILE = Path(__file__).with_suffix(".csv")


def run():
    """Return time, slip, slip rate and traction."""
    dx = H / CELLS
    dt = COURANT * dx / C
    shear = RHO * C**2
    velocity = PULL * np.linspace(0.0, 1.0, CELLS + 1)
    stress, rows, slip, rate = np.full(CELLS, STRESS), [], 0.0, 0.0
    for n in range(int(np.ceil(DURATION / dt)) + 1):
        growth = shear * np.diff(velocity) / dx
        felt = stress + DAMPING * dt * growth
        velocity[1:-1] += dt / (RHO * dx) * np.diff(felt)
        velocity[-1] += 2.0 * dt / (RHO * dx) * (STRESS - felt[-1])
        held = felt[0] + 0.5 * RHO * dx / dt * velocity[0]  # the traction that would stop the node
        traction, rate = held, 0.0
        if held > S * STATIC:  # it slips: (rho dx / 2 dt) v + S mu(v) = held, by fixed-point steps from the velocity before
            rate = max(velocity[0], 0.0)
            for _ in range(200):
                traction = S * (DYNAMIC + (STATIC - DYNAMIC) / (1.0 + ALPHA * rate))
                rate = max(2.0 * dt / (RHO * dx) * (held - traction), 0.0)
        velocity[0] = rate
        rows.append((n * dt, slip, rate, traction))
        slip += dt * rate
        stress = stress + dt * shear * np.diff(velocity) / dx
    return np.array(rows)


if __name__ == "__main__":
    names = "time_s,slip_m,slip_rate_m_per_s,traction_Pa"
    np.savetxt(FILE, run()[::4], fmt="%.7g", delimiter=",", header=names, comments="")
