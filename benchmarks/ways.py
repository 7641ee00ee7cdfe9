"""The steps of seven ways through the package: what is typed, how long it may take, and what it must say."""

from __future__ import annotations

import math
from typing import NamedTuple

from benchmarks.own_files import DRIFT, ROCK, ROSIN, SLIDE, newmark


class Number(NamedTuple):
    """A number that must be printed: a pattern whose one group is the number, the truth, and the share by which it may be off."""

    pattern: str
    value: float
    within: float


class Step(NamedTuple):
    """A command without its first word, or Python after "python: "; `> FILE` at the end keeps what it prints.

    `bound` is the processor time (s) that it may take, start and figure included: three to six times what an idle machine takes.
    """

    typed: str
    bound: float
    wanted: tuple[str | Number, ...] = ()
    code: int = 0


def fitted(name: str, within: float) -> Number:
    """Return what the table of a fit must say of a number of ROCK; the scenario's reference is friction at 1 um/s, not at 10."""
    truth = ROCK | {"reference": ROCK["reference"] - (ROCK["a"] - ROCK["b"]) * math.log(10.0)}
    return Number(rf"{name}\s+([-+.\de]+)", truth[name], within)


WAYS: dict[str, tuple[Step, ...]] = {
    "rupture physics": (
        Step("--help", 6, (r"new slab > mine\.toml", r"\n  compare ")),
        Step("doctor", 25, (r"closed form",)),
        Step("check fig6-slab --figure k.png", 15, (r"critical value\s+friction\.alpha = 0\.196 s/m", r"written: k\.png")),
        Step("run fig6-slab --figure run.png", 15, (r"slip at the end\D{0,40}23\.440", r"1 slip event", r"written: run\.png")),
        Step(
            'compare fig6-slab --rules --duration "480 years" --figure rules.png',
            25,
            (r"maxwell", r"maximal", r"394\.2\d+ years"),
        ),
        Step(
            "sweep fig6-slab -v alpha=0.05..2:20 -v thickness=1..50km:20 --figure map.png",
            30,
            (r"400 finished", r"written: map\.png"),
        ),
        Step("run planar-patch --figure fault.png", 120, (r"written: fault\.png",)),
    ),
    "tribology": (
        Step("fit axis.txt", 20, (r"40 points along slip_rate", r"hyperbolic-rate\s+3\s+0\.000\d+\s+0\.0")),
        Step(
            "fit axis.txt --law hyperbolic-rate --body block --set body.normal_force=2kN --set body.mass=200 "
            '--set "body.stiffness=20 N/um" --set "body.damping=20 kN s/m" --set "pull_rate=500 mm/min" --out axis.toml',
            20,
            (
                Number(r"static\s+([\d.]+)", SLIDE["static"], 0.01),
                Number(r"dynamic\s+([\d.]+)", SLIDE["dynamic"], 0.02),
                Number(r"alpha\s+([\d.]+)", SLIDE["alpha"], 0.05),
            ),
        ),
        Step(
            "check axis.toml --steady-figure steady.png",
            20,
            (r"^(?!.*Fig\. 6)", r"steady sliding.*8\.33333 mm/s|500 mm/min", r"stable"),
        ),
        Step("run axis.toml --figure axis.png", 20, (r"slip at the end", r"written: axis\.png")),
        Step("run reversing-axis --friction-figure loop.png", 20, (r"written: loop\.png",)),
    ),
    "drilling": (
        Step("new string > string.toml", 6),
        Step(
            'check string.toml --no-runs --set "pull_rate=120 1/min" --set "weight_on_bit=20 klbf"',
            15,
            (r"120 (1/min|rpm)", r"klbf"),
        ),
        Step("run drill-string --figure string.png", 20, (r"rpm", r"written: string\.png")),
        Step("find drill-string --figure edge.png", 60, (Number(r"([\d.]+) rpm", 121.9, 0.03), r"written: edge\.png")),
        Step(
            "infer drill-string floor.csv --free dynamic,viscosity --begin-at dynamic=0.45 --begin-at viscosity=0.002",
            60,
            (Number(r"dynamic\s+([\d.]+)", 0.5, 0.01), Number(r"viscosity\s+([\d.]+)", 0.0033, 0.1)),
        ),
    ),
    "laboratory geophysics": (
        Step("run velocity-steps-block --friction-figure steps.png", 25, (r"slip at the end", r"written: steps\.png")),
        Step(
            "infer velocity-steps-block shear.csv --free a,b,distance,stiffness,reference "
            '--column load_point="Vert_disp (micron)" --figure fit.png --scenario-out best.toml --report report',
            90,
            (
                r"trend",
                *(fitted(name, 0.02) for name in ("a", "b", "distance", "stiffness")),
                fitted("reference", 0.001),
                Number(r"trend\s+([-+.\de]+)", -DRIFT, 0.05),
                r"written: fit\.png",
            ),
        ),
        Step("run best.toml --figure best.png", 25, (r"written: best\.png",)),
    ),
    "teaching": (
        Step("paper --out paper", 180, (r"report\.html",)),
        Step(
            "run fig5-slab-reconstructed --space-time waves.png --animation slab.gif", 60, (r"3 slip|pulses", r"written: slab\.gif")
        ),
        Step(
            "infer velocity-steps-block lab.lvm --free a,b,distance,reference,stiffness --figure lab.png",
            60,
            (*(fitted(name, 0.05) for name in ("a", "b", "distance")),),
        ),
    ),
    "soil dynamics": (
        Step("check slope.toml", 15, (r"0\.3 g|2\.94",)),
        Step(
            "run slope.toml --figure slope.png",
            20,
            (Number(r"slip at the end\D{0,40}?([\d.]+) m\b", newmark(), 1e-4), r"written: slope\.png"),
        ),
        Step("run slope.toml --catalogue slides.csv", 20, (r"3 slip events", r"written: slides\.csv")),
        Step("show slides.csv --catalogue-figure slides.png", 20, (r"0\.2376", r"written: slides\.png")),
        Step("export slope.toml slope.csv --sampling-rate 100", 20, (r"written: slope\.csv",)),
    ),
    "acoustics and codes": (
        Step("run bowed-string-slab --figure string.png", 20, (r"written: string\.png",)),
        Step(
            "fit rosin.csv --law hyperbolic-rate --body bowed-string-slab --out bow.toml",
            20,
            (Number(r"alpha\s+([\d.]+)", ROSIN["alpha"], 0.02), r"written: bow\.toml"),
        ),
        Step("run bow.toml --out bow.nc", 20, (r"slip at the end", r"written: bow\.nc")),
        Step("show bow.nc --csv bow.csv", 20, (r"written: bow\.csv",)),
        Step("benchmark get loop", 20, (r"written: loop\.toml",)),
        Step("export loop.toml loop.txt --sampling-rate 1000", 20, (r"written: loop\.txt",)),
        Step("benchmark judge loop.txt", 25, (r"Rule perfect-delay: loop", r"Passed")),
        Step(
            'python: import stickslip as ss; run = ss.simulate("loop.toml"); print(run.to_csv("again.csv"), float(run.slip()))',
            20,
            (r"again\.csv",),
        ),
    ),
}
"""Steps by trade, in the order in which somebody who reads the help would try them."""
