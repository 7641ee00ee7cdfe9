"""
Basalt and sepiolite
====================

Two velocity steps that were measured on rocks: basalt from 3 to 10 um/s, sepiolite from 0.2 to 2 um/s. Both were published with a
routine that removes the trend of such records (Giacomel, Faulkner, Lambert & Allen 2024, Geosphere, doi:10.1130/GES02739.1). The
files hold each 10th sample, and each 4th to 80th; their first lines name source and licence.

You learn to fit records as they come from a machine, with a trend that no law explains, and to read what the residual shows.
"""

import sys
from dataclasses import replace
from pathlib import Path

import stickslip as ss

problem = ss.load_scenario("velocity-steps-block").problem
records = Path(sys.argv[0]).parent / "records"  # beside this script
begin = {
    "basalt": {"reference": 0.607, "rate": "3 um/s"},
    "sepiolite": {"reference": 0.535, "rate": "0.2 um/s", "distance": "100 um"},
}
free = ["a", "b", "distance", "stiffness", "reference", "record.trend"]
found = {}
for rock, known in begin.items():
    start = replace(problem, friction=replace(problem.friction, **known))
    found[rock] = ss.studies.infer(start, records / f"{rock}_velocity_step.csv", free, starts=1)
    print(found[rock])

# %%
# Basalt hardly cares about the rate: a and b are alike, and go together (their correlation is above 0.9), so that a - b is
# known far better than either. Sepiolite strengthens with the rate, a - b = 0.006, over a distance of 0.17 mm, on top of a
# trend of -26 per metre of slip.
#
# The residual of sepiolite rises and falls with a period of some 400 s before the step and of 40 s after it, which is 80 um of
# slip. Neither the law nor the block has such a length: it may come from the machine. Noise with a memory allows for it, so
# that the intervals are wider than those of white noise.

figure = found["sepiolite"].plot()
other = found["basalt"].plot()
