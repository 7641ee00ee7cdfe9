"""Claim 22, on chains of blocks: only where the extension of chains is there."""

from __future__ import annotations

import math

import numpy as np

import stickslip as ss
from stickslip.extensions.paper.cases import Runs
from stickslip.extensions.paper.claims.verdict import ClaimVerdict, Outcome, claim, each, judge, verdict
from stickslip.foundation.arrays import Floats

BLOCKS_OF_CHAIN, UNTIL, TRANSIENT = 100, 8_000.0, 2_000.0
"""Blocks of each chain, how long it runs (s), and the time (s) at the start whose events are left out."""
DRY = ss.friction.Coulomb(static=1.0, dynamic=0.7)
CHAINS: dict[str, tuple[float, int, ss.friction.FrictionLaw]] = {
    "kc/kp = 1": (1.0, 1, DRY),
    "kc/kp = 10": (10.0, 1, DRY),
    "kc/kp = 10, another start": (10.0, 2, DRY),
    "kc/kp = 10, smaller drop": (10.0, 1, ss.friction.Coulomb(static=1.0, dynamic=0.9)),
    "kc/kp = 10, weakening with slip": (10.0, 1, ss.friction.LinearSlipWeakening(1.0, 0.7, 0.02, memory="since-arrest")),
    "kc/kp = 10, weakening with slip rate": (10.0, 1, ss.friction.HyperbolicRate(static=1.0, dynamic=0.7, alpha=20.0)),
    "kc/kp = 40": (40.0, 1, DRY),
}
"""Springs between blocks (N/m; those to the driver have 1), seed of the start, and the law of all blocks."""
OF_SEISMICITY = (0.7, 1.3)
"""Slopes b of most catalogues of earthquakes lie between these."""
RICH_DECADES, RICH_IRREGULARITY = 1.0, 0.5
"""A catalogue is rich if its moments span more decades, and its waits deviate by a larger share of their mean, than this."""
LARGE_QUANTILE, WAITS_AFTER = 0.95, 3.0
"""Events above this quantile of moments are large; what follows within so many mean waits comes after one."""
FITS = 0.05
"""The law is said to fit if more of the catalogues drawn from it than this share are as far."""


def chain(coupling: float, seed: int, law: ss.friction.FrictionLaw) -> ss.Chain:
    """Return a chain of equal blocks that start out of place, and slip forward only."""
    start = ss.Drawn("uniform", -0.5 / math.sqrt(coupling), 0.0, seed=seed)
    return ss.Chain(law, BLOCKS_OF_CHAIN, 1.0, coupling, 1.0, 1.0, 1e-3, initial_slip=start, direction="forward")


@claim(22, "Chains of sliders behave in a very rich and complex way, similar by several ways to observed seismicity.")
def chains_and_seismicity(runs: Runs) -> ClaimVerdict:
    """Measure sizes, the slope of their frequency, how well the law fits, and how irregular the times between events are."""
    decades, slopes, fits, irregular, after = {}, {}, {}, {}, {}
    for name, numbers in CHAINS.items():
        events = ss.simulate(chain(*numbers), UNTIL).events
        late = events[(events["time"] > TRANSIENT) & (events["moment"] > 0.0)]
        magnitudes = ss.studies.magnitudes(late["moment"], "moment")
        found = ss.studies.gutenberg_richter(magnitudes, magnitudes.min())  # the catalogue of a run lacks no event
        waits = np.diff(late["time"])
        decades[name] = float(np.log10(late["moment"].max() / late["moment"].min()))
        slopes[name], fits[name], irregular[name] = found.b, found.p_value, float(waits.std() / waits.mean())
        after[name] = events_after_large_ones(late["time"], late["moment"])
    rich = min(decades.values()) > RICH_DECADES and min(irregular.values()) > RICH_IRREGULARITY
    alike = all(OF_SEISMICITY[0] < b < OF_SEISMICITY[1] for b in slopes.values())
    same = rich and alike and min(fits.values()) > FITS and min(after.values()) > 1.0
    why = (
        "Events over decades of size, at irregular times, come of equal blocks without any disorder but the start. The rest is "
        "not that of seismicity: how many events there are of each size depends on the ratio of springs and on the law most, on "
        "the start hardly; no catalogue follows the Gutenberg-Richter law, since those drawn from it are "
        "closer; and after a large event there are fewer than usual, not more, as aftershocks are."
    )
    return verdict(
        Outcome.QUALIFIED if rich and not same else judge(same),
        "sizes and times, not their frequency and what follows them",
        why,
        *each("decades of moment", decades),
        *each("deviation of waits over their mean", irregular),
        *each("b of (2/3) log10 M", slopes),
        *each("share of drawn catalogues that are as far", fits),
        *each("events after large ones, over the mean", after),
    )


def events_after_large_ones(time: Floats, moment: Floats) -> float:
    """Return how many events follow one of the largest twentieth within three mean waits, over the three that do on average."""
    window = WAITS_AFTER * float(time[-1] - time[0]) / len(time)
    large = time[(moment >= np.quantile(moment, LARGE_QUANTILE)) & (time < time[-1] - window)]
    following = np.searchsorted(time, large + window, side="right") - np.searchsorted(time, large, side="right")
    return float(following.mean()) / WAITS_AFTER
