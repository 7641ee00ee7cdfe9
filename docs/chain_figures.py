"""Draw the figures of docs/chain.md, but for that of fixed steps, and print its table of slopes.

python docs/chain_figures.py
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import stickslip as ss
from stickslip.extensions.chains.changes_between import changes_between, slips_of

FIGURES = Path(__file__).with_name("figures")
DRY = ss.friction.Coulomb(static=1.0, dynamic=0.7)
SLAB = ss.ElasticSlab(density=1.0, wave_speed=1.0, thickness=1.0, normal_stress=1.0)
COUPLINGS, SEEDS, SPREADS = (1.0, 10.0, 40.0), (1, 2), (0.0, 0.1)
STRINGS = (32, 64, 128)
"""Numbers of blocks with friction on every one."""
UNTIL, TRANSIENT = 20_000.0, 3_000.0
"""How long chains run, and the time (s) whose events are left out."""


def chain(coupling: float, seed: int, spread: float = 0.0) -> ss.Chain:
    """Return 200 blocks that start out of place, with strengths that differ by up to a share."""
    rough = 0.5 / np.sqrt(coupling)
    strength: Any = ss.Drawn("uniform", 1.0 - spread, 1.0 + spread, seed=100 + seed) if spread else 1.0
    start = ss.Drawn("uniform", -rough, 0.0, seed=seed)
    return ss.Chain(DRY, 200, 1.0, coupling, 1.0, strength, 1e-3, initial_slip=start, direction="forward")


def print_slopes() -> None:
    """Print beta of the catalogue of each chain, and whether the law fits."""
    for coupling in COUPLINGS:
        for spread in SPREADS:
            for seed in SEEDS:
                run = ss.simulate(chain(coupling, seed, spread), UNTIL)
                events = run.events[(run.events["time"] > TRANSIENT) & (run.events["moment"] > 0.0)]
                found = ss.studies.gutenberg_richter(ss.studies.magnitudes(events["moment"]))
                about = f"kc/kp {coupling:g}, strengths by {spread:g}, seed {seed}: {len(events)} events"
                print(f"{about}, the largest of {events['size'].max()} blocks, beta {found.beta:.3f}, p {found.p_value:.3f}")


def print_strings() -> None:
    """Print how often, and for how long, blocks slip in the first event of all blocks, with friction on every block."""
    for count in STRINGS:
        law = ss.friction.Coulomb(static=0.8, dynamic=0.3)
        stiffness = [0.0] * (count - 1) + [count]
        run = ss.simulate(ss.Chain(law, count, 1.0 / count, float(count), stiffness, 1.0 / count, 1e-4), 6e4, keep="changes")
        event = run.events[(run.events["time"] > 2e4) & (run.events["size"] == count)][0]
        first, last = float(event["time"]), float(event["time"] + event["duration"]) * (1.0 + 1e-12)
        slips = slips_of(changes_between(run, first, last), run.at(last).slip[0])
        times, lasts = len(slips.block) / count, float(np.median(slips.arrest - slips.onset))
        front = float(slips.onset[slips.block == 0].min()) - first
        said = f"each slips {times:.2f} times, for {lasts:.4f} s; the far end begins {front:.3f} s after the other"
        print(f"{count} blocks: {said}")


def draw() -> None:
    """Draw rupture, chain beside slab, and the front in place of a shock."""
    run = ss.simulate(chain(10.0, 1), 5_000.0)
    look = {"dpi": 130}
    weakening = ss.friction.LinearSlipWeakening(static=0.8, dynamic=0.3, distance=0.2)
    smooth = ss.Problem(SLAB, weakening, pull_rate=0.01, initial_excess=0.0)
    shock = ss.Problem(SLAB, DRY, pull_rate=0.01, initial_excess=0.0)
    pictures = {
        "chain-rupture.png": run.plot.rupture(**look),
        "chain-frequency.png": run.plot.frequency(**look),
        "chain-beside-slab.png": ss.studies.chain_beside_slab(smooth, 4.0, (16, 32, 64, 128)).plot(**look),
        "chain-front.png": ss.studies.chain_beside_slab(shock, 1.9, (16, 32, 64, 128)).plot(**look),
    }
    for name, figure in pictures.items():
        figure.savefig(FIGURES / name, metadata={"Software": None})


if __name__ == "__main__":
    print_slopes()
    print_strings()
    draw()
