"""Measure the study of sliding beside the plain exact loop and pySLAMMER, in one run.

Run `python -m benchmarks.records FOLDER [--peer PYTHON]`. The folder holds records, as pySLAMMER's sample_ground_motions; PYTHON is
the interpreter of an environment with pySLAMMER, which is left out without it. Times are the least of several tries, in the same
process for ours and the loop, and within its own process for pySLAMMER, without its start and without reading.
"""

from __future__ import annotations

import argparse
import math
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
import numpy as np

import stickslip as ss
from stickslip.extensions.strong_motion.motion import GroundMotion, motions_of
from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import GRAVITY

YIELDS_OF_ALL = (0.05, 0.1, 0.2)
"""Yield coefficients of the runs of all records."""
MANY_YIELDS = np.linspace(0.02, 0.7, 200)
"""Yield coefficients of one record."""
LANDERS = 9495
"""Number of samples of the record with many yields: the first of this length, or else the longest."""
TRIES = 7
PEER = """
import sys, time
import numpy as np, pyslammer as ps
from pathlib import Path
folder, yields_all, tries = Path(sys.argv[1]), [float(x) for x in sys.argv[2].split(",")], int(sys.argv[3])
motions = [(np.load(one), float(one.stem.split("_")[-1])) for one in sorted(folder.glob("*.npy"))]
def all_runs():
    return [
        ps.RigidAnalysis(ky, ps.GroundMotion(sign * a, dt, "")) for a, dt in motions for sign in (-1.0, 1.0) for ky in yields_all
    ]
def many():
    a, dt = motions[int(sys.argv[4])]
    return [ps.RigidAnalysis(float(ky), ps.GroundMotion(a, dt, "")) for ky in np.linspace(0.02, 0.7, 200)]
for work in (all_runs, many):
    times = []
    for _ in range(tries):
        begin = time.perf_counter(); found = work(); times.append(time.perf_counter() - begin)
    print(min(times))
    if work is all_runs:
        print(",".join(repr(float(one.max_sliding_disp)) for one in found))
"""
"""What pySLAMMER is asked: all runs of all records in both polarities, and many yields of one; times (s) and displacements."""


@numba.njit(cache=False)  # type: ignore[untyped-decorator] # numba has no types
def plain_loop(load: Floats, interval: float, strength: float) -> float:
    """Return the displacement (m) by the plain exact loop over all segments: what the problem asks for, and nothing else."""
    moves, velocity, place = False, 0.0, 0.0
    for n in range(len(load) - 1):
        begin, end = load[n] - strength, load[n + 1] - strength
        slope, lasting, speed = (end - begin) / interval, interval, begin
        if not moves:
            if begin <= 0.0 and end <= 0.0:
                continue
            moves, velocity = True, 0.0
            if begin <= 0.0:
                lasting, speed = end / slope, 0.0
        while lasting > 0.0:
            stop = lasting
            after = velocity + lasting * (speed + 0.5 * slope * lasting)
            square = speed * speed - 2.0 * slope * velocity
            if after <= 0.0 or (speed < 0.0 and square > 0.0 and end > 0.0 and velocity > 0.0):
                root = math.sqrt(max(square, 0.0))
                stop = 2.0 * velocity / (root - speed) if speed < 0.0 else -(speed + root) / slope
                stop = min(stop, lasting)
            place += stop * (velocity + stop * (0.5 * speed + slope * stop / 6.0))
            velocity += stop * (speed + 0.5 * slope * stop)
            if stop >= lasting and after > 0.0:
                break
            moves, velocity, lasting = False, 0.0, 0.0
            if end > 0.0:
                moves, lasting, speed = True, end / slope, 0.0
    return place + (0.5 * velocity * velocity / strength if moves else 0.0)


def least(work: Callable[[], Any]) -> float:
    """Return the least time (s) of several tries."""
    times = []
    for _ in range(TRIES):
        begin = time.perf_counter()
        work()
        times.append(time.perf_counter() - begin)
    return min(times)


def looped(motion: GroundMotion, yields: Floats, sign: float) -> Floats:
    """Return displacements (m) by the plain loop, which slides forward for sign times the acceleration."""
    load = sign * motion.acceleration
    return np.array([plain_loop(load, motion.interval, GRAVITY * one) for one in yields])


def peer(python: str, motions: list[GroundMotion], place: int) -> list[str]:
    """Return the lines that pySLAMMER prints."""
    with tempfile.TemporaryDirectory() as folder:
        for n, one in enumerate(motions):
            np.save(Path(folder) / f"{n:03d}_{one.interval!r}.npy", one.acceleration / GRAVITY)
        given = [folder, ",".join(map(str, YIELDS_OF_ALL)), str(3), str(place)]
        done = subprocess.run([python, "-c", PEER, *given], capture_output=True, text=True, check=True)
    return done.stdout.split()


def main() -> None:
    """Print a table of times, and of differences from the plain loop."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.records", description="Measure the study of sliding.")
    parser.add_argument("folder", type=Path, help="a folder with records")
    parser.add_argument("--peer", help="the Python of an environment with pySLAMMER")
    given = parser.parse_args()
    begin = time.perf_counter()
    motions = motions_of(given.folder, "records")
    reading = time.perf_counter() - begin
    lengths = [len(one.acceleration) for one in motions]
    place = lengths.index(LANDERS) if LANDERS in lengths else int(np.argmax(lengths))
    one = motions[place]
    looped(one, MANY_YIELDS[:1], 1.0)
    ss.studies.sliding(one, 0.1)

    def fresh() -> list[GroundMotion]:
        return [GroundMotion(each.name, each.acceleration, each.interval) for each in motions]

    many = least(lambda: ss.studies.sliding(fresh()[place], MANY_YIELDS, polarity=-1))
    many_loop = least(lambda: looped(one, MANY_YIELDS, 1.0))
    every = least(lambda: ss.studies.sliding(fresh(), YIELDS_OF_ALL))
    yields = np.array(YIELDS_OF_ALL)
    every_loop = least(lambda: [looped(each, yields, sign) for each in motions for sign in (-1.0, 1.0)])
    ours = ss.studies.sliding(motions, YIELDS_OF_ALL).table.displacement.to_numpy()
    loop = np.concatenate([looped(each, yields, sign) for each in motions for sign in (-1.0, 1.0)])
    runs = f"{len(motions)} records x 2 polarities x {len(yields)} yields"
    times = [f"{1e3 * many:.1f}", f"{1e3 * many_loop:.1f}", f"{1e3 * every:.1f}", f"{1e3 * every_loop:.1f}"]
    line = "| ours, by ss.studies.sliding | {} | {} |\n| plain exact loop, numba | {} | {} |\n"
    sys.stdout.write(f"read {len(motions)} records, {sum(lengths)} samples, in {reading:.2f} s\n")
    sys.stdout.write(f"| ms | {len(MANY_YIELDS)} yields of {len(one.acceleration)} samples | {runs} |\n| --- | --- | --- |\n")
    sys.stdout.write(line.format(times[0], times[2], times[1], times[3]))
    slid = loop > 0.0
    off = np.abs(ours[slid] / loop[slid] - 1.0)
    sys.stdout.write(f"ours and the loop differ by {np.median(off):.1e} in the median, {off.max():.1e} at most\n")
    if given.peer:
        every_peer, found, many_peer = peer(given.peer, motions, place)
        theirs = np.array([float(x) for x in found.split(",")])
        off = np.abs(theirs[slid] / loop[slid] - 1.0)
        sys.stdout.write(f"| pySLAMMER | {1e3 * float(many_peer):.1f} | {1e3 * float(every_peer):.1f} |\n")
        sys.stdout.write(f"pySLAMMER and the loop differ by {np.median(off):.1e} in the median, {off.max():.1e} at most\n")


if __name__ == "__main__":
    main()
