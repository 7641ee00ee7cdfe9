"""Records of a velocity step, each with one imperfection, fitted by `infer` and by plain least squares around `simulate`.

    python -m benchmarks.imperfect_records                # 40 records, two of each kind: about a minute
    python -m benchmarks.imperfect_records --coverage 40  # of each kind so many records: do intervals of 95 % hold the truth?

The machine is a double-direct-shear apparatus at 100 MPa, sampled at 1 kHz for 1.8 s. The law is found from a start that is up to a
third away. `rms` is what is left, relative to least squares from the same start. In the column of coverage are the numbers whose
meaning the imperfection leaves; where it does not, infer says so in words, and `words` counts how often.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.signal import lfilter

import stickslip as ss
from stickslip.problem.loading import HoldAndSlide, PiecewiseLinear, Steps

Floats = NDArray[np.float64]
SLOW, FAST, AT = 22.9e-6, 228.4e-6, 0.735
CLOCK = np.arange(1800) * 1e-3
NORMAL = 1e8
LAW = ss.friction.RateAndState(0.49, 0.0062, 0.0044, 30e-6, SLOW, evolution="slip")
BLOCK = ss.SpringBlock(8000.0, 1.6e11, NORMAL)
IDEAL = Steps([0.0, AT], [SLOW, FAST])
TRUTH = ss.Problem(BLOCK, LAW, pull_rate=IDEAL)
START = replace(TRUTH, friction=replace(LAW, a=0.0059, b=0.0045, distance=41e-6))
FREE = ("friction.a", "friction.b", "friction.distance", "friction.reference")
MEANING: dict[str, float] = {name: getattr(LAW, name.partition(".")[2]) for name in FREE}
SAID = ("misses features", "is no noise", "times larger where", "depend more on the window")
"""Parts of the sentences that call a misfit a misfit."""


def friction(problem: ss.Problem, clock: Floats = CLOCK) -> Floats:
    """Return friction at sample times."""
    return np.asarray(ss.simulate(problem, float(clock[-1]) + 1e-3).traction(clock) / NORMAL)


def remembering(random: np.random.Generator, samples: float, size: float, count: int = len(CLOCK)) -> Floats:
    """Return noise whose correlation falls by a factor e in so many samples."""
    rho = np.exp(-1.0 / samples)
    drive = random.standard_normal(count) * np.sqrt(1.0 - rho**2)
    drive[0] /= np.sqrt(1.0 - rho**2)
    return np.asarray(size * lfilter([1.0], [1.0, -rho], drive))


@dataclass(frozen=True)
class Case:
    """A kind of record: friction from a random generator, and what is fitted to it."""

    name: str
    made: Callable[[np.random.Generator], Floats]
    free: Sequence[str] = FREE
    means: bool = True
    """If the numbers of the law mean the same as without the imperfection."""
    problem: ss.Problem = START
    options: dict[str, Any] = field(default_factory=dict)
    keep: Any = ...
    load_point: Callable[[np.random.Generator], Floats] | None = None

    def record(self, seed: int) -> dict[str, Floats]:
        """Return the columns of a record."""
        random = np.random.default_rng(seed)
        columns = {"time (s)": CLOCK[self.keep], "mu": self.made(random)[self.keep]}
        return columns if self.load_point is None else columns | {"load point (m)": self.load_point(random)[self.keep]}


def white(size: float) -> Callable[[np.random.Generator], Floats]:
    """Return the record of the true machine with white noise."""
    return lambda random: friction(TRUTH) + size * random.standard_normal(len(CLOCK))


def with_noise(problem: ss.Problem) -> Callable[[np.random.Generator], Floats]:
    """Return the record of another machine or law with noise that remembers itself for 20 samples, and white noise."""
    return lambda random: friction(problem) + remembering(random, 20.0, 1e-4) + 5e-5 * random.standard_normal(len(CLOCK))


def servo(at: float, lasts: float) -> PiecewiseLinear:
    """Return a pull rate that approaches the faster one exponentially."""
    after = lasts * np.linspace(0.0, 9.0, 200)
    return PiecewiseLinear([0.0, *(at + after)], [SLOW, *(FAST + (SLOW - FAST) * np.exp(-after / lasts))])


RAMP = PiecewiseLinear([0.0, AT, AT + 0.055], [SLOW, SLOW, FAST])
TWO = ss.friction.TwoStateRateAndState(0.49, 0.0062, 0.0030, 30e-6, 0.0014, 300e-6, SLOW, evolution="slip")
HOLDS = HoldAndSlide(FAST, 0.4, [0.4])
HOLD = replace(TRUTH, pull_rate=HOLDS)
TREND = 0.003 / 2e-4
"""Trend of friction (1/m)."""


def moved(problem: ss.Problem) -> Floats:
    """Return the displacement of the load point at sample times (m)."""
    fine = np.linspace(0.0, float(CLOCK[-1]), 100_001)
    rate = np.asarray(problem.pull_rate.at(fine))  # type: ignore[union-attr]
    return np.interp(CLOCK, fine, np.append(0.0, np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(fine))))


def digitised(values: Floats, step: float) -> Floats:
    """Return values as a digitiser with such a step writes them."""
    return np.asarray(step * np.round(values / step))


def trend(random: np.random.Generator) -> Floats:
    """Return friction that rises with slip."""
    return with_noise(TRUTH)(random) + TREND * moved(TRUTH)


def outliers(random: np.random.Generator) -> Floats:
    """Return friction with one sample of 200 far off."""
    return white(1e-4)(random) + np.where(random.random(len(CLOCK)) < 0.005, 4e-3, 0.0)


def uneven(random: np.random.Generator) -> Floats:
    """Return friction with noise that is four times larger after the step."""
    return friction(TRUTH) + 1e-4 * np.where(CLOCK < AT, 1.0, 4.0) * random.standard_normal(len(CLOCK))


def ramp(random: np.random.Generator) -> Floats:
    """Return the load point of a ramp as a digitiser writes it (m)."""
    return digitised(moved(RAMPED) + 2e-8 * random.standard_normal(len(CLOCK)), 7.65e-8)


RAMPED, SERVOED = replace(TRUTH, pull_rate=RAMP), replace(TRUTH, pull_rate=servo(AT, 0.05))
LATE = replace(TRUTH, pull_rate=Steps([0.0, AT + 0.008], [SLOW, FAST]))
CASES = (
    Case("white noise", white(1e-4)),
    Case("noise that remembers itself for 50 ms", lambda r: friction(TRUTH) + remembering(r, 50.0, 3e-4)),
    Case("the same, and white noise", lambda r: white(2e-4)(r) + remembering(r, 50.0, 2e-4)),
    Case("noise four times larger after the step", uneven),
    Case("hum of 50 Hz", lambda r: white(5e-5)(r) + 2e-4 * np.sin(2.0 * np.pi * (50.0 * CLOCK + r.random()))),
    Case("shear in steps of 0.0005", lambda r: digitised(white(1e-4)(r), 5e-4)),
    Case("one sample of 200 far off, robust loss", outliers, options={"loss": "soft_l1"}),
    Case("a fifth of the samples missing", white(1e-4), keep=np.r_[0:1000, 1360:1800]),
    Case("servo of 50 ms, fitted as a step", with_noise(SERVOED), means=False),
    Case("servo of 50 ms, its time free", with_noise(SERVOED), free=(*FREE, "record.servo")),
    Case("ramp of 55 ms, fitted as a step", with_noise(RAMPED), means=False),
    Case("ramp of 55 ms, from a load point in steps of 0.0765 um", with_noise(RAMPED), load_point=ramp),
    Case("step 8 ms late, fitted as given", with_noise(LATE), means=False),
    Case("step 8 ms late, the delay free", with_noise(LATE), free=(*FREE, "record.delay")),
    Case("a second state, fitted with one", with_noise(replace(TRUTH, friction=TWO)), means=False),
    Case("a trend with slip, not fitted", trend, means=False, options={"trend": "none"}),
    Case("a trend with slip, free by itself", trend),
    Case("a trend with slip, free", trend, free=(*FREE, "record.trend")),
    Case("stiffness free", with_noise(TRUTH), free=(*FREE, "body.stiffness")),
    Case("weights as in RSFit3000", with_noise(TRUTH), options={"weight": 0.3}),
    Case("slide, hold, slide", with_noise(HOLD), problem=replace(START, pull_rate=HOLDS)),
)  # fmt: skip


def plain(case: Case, data: dict[str, Floats]) -> tuple[float, float]:
    """Return the root mean square that least squares leaves, and its time (s)."""
    begin, names = time.perf_counter(), [name for name in case.free if not name.startswith("record.")]
    problem, clock = case.problem, data["time (s)"]
    if case.load_point is not None:
        problem = replace(problem, pull_rate=RAMP)

    def residual(x: Floats) -> Floats:
        values = dict(zip(names, np.exp(x).tolist(), strict=True))
        law = replace(problem.friction, **{name.partition(".")[2]: v for name, v in values.items() if name.startswith("friction")})
        body = replace(problem.body, **{name.partition(".")[2]: v for name, v in values.items() if name.startswith("body")})
        return friction(replace(problem, friction=law, body=body), clock) - data["mu"]

    start = [np.log(problem.parameters[name].value) for name in names]
    found = least_squares(residual, start, x_scale="jac", loss=case.options.get("loss", "linear"), f_scale=2e-4)
    return float(np.sqrt(np.mean(found.fun**2))), time.perf_counter() - begin


def tried(case: Case, seeds: int) -> str:
    """Return a row of the table."""
    ratios, times, held, words = [], [], dict.fromkeys(FREE, 0), 0
    for seed in range(seeds):
        data, begin = case.record(seed), time.perf_counter()
        study = ss.studies.infer(case.problem, data, case.free, **({"starts": 1} if seeds > 2 else {}) | case.options)
        lasted, (rms, plain_lasted) = time.perf_counter() - begin, plain(case, data)
        ratios.append(float(study.fit.rms["friction"]) / rms)
        times.append(lasted / plain_lasted)
        words += any(part in note for note in study.notes for part in SAID)
        for name, value in MEANING.items():
            held[name] += study.table.low[name] <= value <= study.table.high[name]
    shares = " ".join(f"{100.0 * count / seeds:4.0f}" for count in held.values())
    told = f"{words:3d} of {seeds}  {'' if case.means else 'other'}"
    return f"{case.name:<56} {max(ratios):6.3f} {np.median(times):6.1f}   {shares}   {told}"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--coverage", type=int, default=2, help="records of each kind")
    parser.add_argument("--only", default="", help="kinds whose name has this text")
    asked = parser.parse_args()
    print(f"{'imperfection':<56} {'rms':>6} {'time':>6}   {'coverage of a b Dc mu0, %'}   words     meaning")  # noqa: T201
    for case in (one for one in CASES if asked.only in one.name):
        print(tried(case, asked.coverage), flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
