"""Draw docs/figures/long-faults.png: fronts that run along a slab, for fracture energies below, at and above G0.

python docs/long_faults.py takes a minute; it prints how fast the fronts gain momentum, beside the closed form.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib import pyplot as plt
from numpy.typing import NDArray

import stickslip as ss
from stickslip.extensions.planar.reference import SteadyFront
from stickslip.extensions.planar.solution import PlanarSolution
from stickslip.figures.style import GREY, LINE_COLOURS

FIGURE = Path(__file__).with_name("figures") / "long-faults.png"
THICKNESS, SPEED, DROP = 10e3, 3500.0, 10e6
SLAB = ss.ElasticSlab(density=2800, wave_speed=SPEED, thickness=THICKNESS, normal_stress=100e6)
FRONT = SteadyFront(DROP, THICKNESS, SLAB.shear_modulus, SPEED)
NODES = 80
"""Nodes in a thickness."""
NUCLEI = {0.6: 0.8, 0.8: 0.8, 0.9: 0.8, 1.0: 0.9, 1.02: 1.0, 1.05: 1.2}
"""Half the length of the nucleus over the thickness, for each fracture energy: it is as strong as it is loaded."""


def run(share: float, strength: float, length: float, duration: float) -> PlanarSolution:
    """Run two fronts that leave a nucleus, with fracture energy `share` G0.

    `strength` is the static minus the dynamic strength, over the stress drop; `length` and `duration` are in h and h/c.
    """
    distance = 2.0 * share * FRONT.released_energy / (strength * DROP)
    law = ss.friction.LinearSlipWeakening(static=0.5 + 0.1 * strength, dynamic=0.5, distance=distance)
    fault = ss.PlanarSlab(
        ss.Problem(SLAB, law, initial_load=60e6),
        nodes=round(NODES * length),
        length=length * THICKNESS,
        along={"friction.static": lambda y: np.where(np.abs(y) < NUCLEI[share] * THICKNESS, 0.5999, 0.5 + 0.1 * strength)},
    )
    return ss.simulate(fault, duration * THICKNESS / SPEED, frames=160)


def weakened(found: PlanarSolution) -> NDArray[np.float64]:
    """Return the time (h/c) at which half of the weakening has happened at each node; NaN where it has not."""
    half, slip = 0.5 * found.slab.problem.parameters["friction.distance"].value, found.slip
    after = np.argmax(slip > half, axis=0)
    low, high = (np.take_along_axis(slip, at[None], axis=0)[0] for at in (np.maximum(after - 1, 0), after))
    with np.errstate(divide="ignore", invalid="ignore"):
        times = found.times[after] - (high - half) / (high - low) * (found.times[after] - found.times[after - 1])
    return np.asarray(np.where(high > half, times, np.nan) * SPEED / THICKNESS)


def speeds(found: PlanarSolution) -> NDArray[np.float64]:
    """Return place (h), time (h/c) and speed (c) of the front, from parabolas through the nodes in half a thickness."""
    y, times, rows = found.slab.y / THICKNESS, weakened(found), []
    for place in np.arange(1.5, 0.5 * found.slab.length / THICKNESS - 1.0, 0.25):
        near = (np.abs(y - place) <= 0.25) & np.isfinite(times)
        if near.sum() > NODES // 4:
            _, slowness, time = np.polyfit(y[near] - place, times[near], 2)
            rows.append((place, time, 1.0 / slowness))
    return np.array(rows)


def main() -> None:
    """Run, print and draw."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.6, 3.6), layout="constrained")
    for share, colour in zip(list(NUCLEI)[1:], LINE_COLOURS, strict=False):
        place, time, speed = speeds(run(share, 3.0, 26.0, 18.0)).T
        left.plot(place, speed, ".", color=colour, markersize=4, label=f"$G_c$ = {share:g} $G_0$")
        start, first = int(np.argmax(place >= 3.0)), float(speed[(place >= 2.5) & (place <= 3.5)].mean()) * SPEED
        since = np.linspace(0.0, time[-1] - time[start] + 3.0 * (share > 1.0), 400)
        theory = FRONT.speed(since * THICKNESS / SPEED, share * FRONT.released_energy, first) / SPEED
        path = place[start] + np.append(0.0, np.cumsum(0.5 * (theory[1:] + theory[:-1]) * np.diff(since)))
        left.plot(path, theory, color=colour, linewidth=0.9)
        seen = (place >= 3.0) & (speed > 0.15) & (speed < 0.93)
        gains = np.polyfit(time[seen], speed[seen] / np.sqrt(1.0 - speed[seen] ** 2), 1)[0]
        wanted = (1.0 - share) / FRONT.INERTIA
        print(f"Gc = {share:g} G0: d(V/a)/dt = {gains:.3f} c^2/h, closed form {wanted:.3f}; seen up to {place[-1]:.2f} h")
    left.set(xlabel="distance $y/h$", ylabel="speed of the front $V/c$", ylim=(0.0, 1.05), xlim=(1.0, 12.5))
    left.legend(fontsize=8, loc="lower left")
    for share, colour in ((0.6, LINE_COLOURS[0]), (1.0, LINE_COLOURS[2])):
        found = run(share, 2.0, 26.0, 16.0)
        node = int(np.argmin(np.abs(found.slab.y - 3.5 * THICKNESS)))
        since = found.times * SPEED / THICKNESS - weakened(found)[node]
        slip = found.slip[:, node] / FRONT.final_slip
        right.plot(since, slip, color=colour, label=f"$G_c$ = {share:g} $G_0$")
        rests = since[(since > 0.0) & (found.slip_rate[:, node] == 0.0)]
        print(f"Gc = {share:g} G0: slip {slip.max():.4f} drop h/G; first at rest {rests[:1]} h/c behind the front")
    right.axhline(1.0, color=GREY, linewidth=0.8, linestyle=":")
    right.set(
        xlabel="time after the front, in $h/c$",
        ylabel=r"slip at $y = 3.5h$, in $(\tau_0 - \tau_d) h/G$",
        xlim=(-0.5, 4.0),
        ylim=(0.0, 1.25),
    )
    right.legend(fontsize=8, loc="lower right")
    figure.savefig(FIGURE, dpi=150)


if __name__ == "__main__":
    main()
