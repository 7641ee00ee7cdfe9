"""What `infer` is asked for: its arguments as a record, and what is said of each, in Python and on the command line.

Nothing here needs numpy: the command line starts without it.
"""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, Any

from stickslip.foundation.takes import Said

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from stickslip.foundation.conversion import WithUnit
    from stickslip.problem import Problem
    from stickslip.problem.scenarios import Scenario
    from stickslip.run import TextProgress


@dataclass(frozen=True, eq=False)
class Wishes:
    """The arguments of `infer`, in their order; `WORDS` has what is said of each."""

    problem: Problem | Scenario | str | Path
    record: Any
    free: Sequence[str] | str
    _: KW_ONLY
    begin: float | str | WithUnit | None = None
    end: float | str | WithUnit | None = None
    progress: TextProgress | bool | None = None
    by: str = "samples"
    observe: Sequence[str] | str | None = None
    start: str | None = None
    sensor: str = "contact"
    normal: str = "problem"
    parts: str | None = None
    each: Sequence[str] | None = None
    bounds: Mapping[str, Any] | None = None
    priors: Mapping[str, Any] | None = None
    begin_at: Mapping[str, Any] | None = None
    loss: str = "linear"
    weight: float = 0.0
    windows: bool = False
    starts: int = 4
    held_out: float | str | WithUnit | None = None
    profiles: bool = False
    samples: int = 0
    seed: int = 0
    rtol: float = 1e-8  # far below the noise of a laboratory
    checkpoint: str | Path | None = None
    trend: str = "auto"
    max_time: float | str | WithUnit | None = None


WORDS = {
    "problem": Said(
        "Problem, Scenario, str or Path",
        "The problem, with starting values for the search: itself, its scenario, the name of a bundled scenario, or a file.",
    ),
    "record": Said(
        "str, Path, DataFrame, mapping, Record, or list of them",
        "The record: a CSV file, or columns by their headings, as `Record.read` describes. Several records share the free numbers.",
    ),
    "free": Said(
        "str or list of str",
        'The numbers to find, with commas: "a,b,body.stiffness".',
        'Names, or a list of them: those of `problem.parameters`, and "initial.load", "initial.state", "record.trend" (friction '
        'per metre of slip), "record.drift" (friction per second), "record.delay" (s, by which the record is late) and '
        '"record.servo" (s: after a step the load point approaches its new rate as exp(-t/servo)).',
    ),
    "begin": Said("float or str, optional", "Take the record from this time on (s, or with a unit)."),
    "end": Said("float or str, optional", "Take the record up to this time."),
    "progress": Said(
        "bool or callable, optional", "True shows the progress in one line. A function is called with a line of text."
    ),
    "by": Said(
        '{"samples", "features"}',
        "What is fitted: samples, or features of slip events.",
        "Features are those of stick-slip, with their scatter from event to event. A table may have them, a row for each event.",
    ),
    "observe": Said(
        "str or list of str, optional",
        "Which samples or features: friction, shear_stress, shear_force, torque, slip, slip_rate, surface_torque, drive_rate; "
        "peak, rest, drop, recurrence, duration, event_slip, peak_rate.",
        "Samples are by default shear if the record has it, or else all of them; surface_torque and drive_rate are measured at the "
        "drive of a string. Features are by default all that the record has except the drop (peak minus rest).",
    ),
    "start": Said(
        '{"steady", "record", "problem"}, optional',
        "How the run begins: steady, record (load of the first samples) or problem.",
        "The default is steady sliding at the first pull rate for a law with a state that never sticks, and the record for others.",
    ),
    "sensor": Said(
        '{"contact", "spring", "drive"}',
        "Where shear is measured: contact, spring (load cell of a block), or drive (torque of a top drive).",
        "They differ by the inertia of the block, or by the waves in the body.",
    ),
    "normal": Said(
        '{"problem", "record"}',
        "Normal load of the runs: problem, or record (its column, as it varies).",
        '"record" follows the normal stress (slab) or force (block) of the record in time, by the fewest straight lines that fit '
        "it within its noise; that of the problem is constant or not.",
    ),
    "parts": Said(
        '"rests", optional',
        "rests: a run of its own after each slip event of the record.",
        "Each begins with the load that is measured there.",
    ),
    "each": Said(
        "list of str, optional",
        "What is free for each part between rests: initial.load, initial.state.",
        "By default initial.load within its noise, and initial.state if the law has one.",
    ),
    "bounds": Said(
        "mapping, optional",
        'Limits of a number: "friction.a=0.001..0.1".',
        "In Python a lower and an upper limit by name. The default for positive quantities is a factor of 1000 to both sides of "
        "the starting value, or of 30 for pure numbers.",
    ),
    "priors": Said(
        "mapping, optional",
        'What you know beforehand: "friction.a=normal(0.01, 0.002)"; lognormal and uniform too.',
        'In Python by name: "normal(0.6, 0.05)", "lognormal(10 um, 0.5)" (median and standard deviation of the logarithm), or '
        '"uniform(0, 1)".',
    ),
    "begin_at": Said(
        "mapping, optional",
        "Where the search for a number begins: NAME=VALUE.",
        "In Python values by name; by default those that the record shows, or else those of the problem.",
    ),
    "loss": Said(
        '{"linear", "soft_l1", "huber", "cauchy"}',
        "How residuals count: linear; soft_l1, huber or cauchy for outliers.",
    ),
    "weight": Said(
        "float",
        "More weight for samples soon after a change of the pull rate: exponent p of (n/j)^p, as in RSFit3000.",
        "It is that of the j-th of n samples (Skarbek & Savage 2019, Geosphere 15, 1665). At 0 all samples count alike.",
    ),
    "windows": Said(
        "bool",
        "Fit shorter parts of the record, too, and show the spread.",
        "`found.windows` has the numbers, and a note their spread.",
    ),
    "starts": Said(
        "int",
        "How many starts the search has.",
        "They are the given one, and the best of twelve times as many draws. If several starts do not lead near the record, a "
        "search without derivatives follows.",
    ),
    "held_out": Said(
        "float or str, optional",
        'Leave the end out, to be predicted: a share as 0.3, or "100 s".',
    ),
    "profiles": Said("bool", "Intervals from profiles of the likelihood.", "Otherwise they follow from its curvature."),
    "samples": Said("int", "Samples of the posterior distribution to draw (needs emcee)."),
    "seed": Said("int", "Seed of starts and samples."),
    "rtol": Said("float", "Relative tolerance of the runs."),
    "checkpoint": Said(
        "str or Path, optional",
        "Keep the samples in this file (.nc) while they are drawn; the same call goes on with them.",
        "If the program is killed, the same call fits again; its result is the same, bit for bit.",
    ),
    "trend": Said(
        '{"auto", "none"}',
        "auto: a drift with slip or time is free, too, if plateaus of friction show one; none: it is not.",
        'The drift is "record.trend" or "record.drift", and is kept if the fit needs it: a note says so.',
    ),
    "max_time": Said(
        "float or str, optional",
        'Processor time (s, or as "1 h") after which the best numbers so far are the result; 10 min for the search by default.',
        "Notes say what is left and what may help. Profiles, windows and samples take as long as they need by default.",
    ),
}
"""What is said of each argument."""
