"""
The series of another code
==========================

The file holds what another program says about the loop of Fig. 4: time, slip, slip rate and traction, in CSV. The program is in
`records/staggered_grid.py`: velocities at nodes, stresses between them, a trial stick, and some viscosity against ringing.

You learn to have a series from any code judged: its errors, each of its shocks beside the exact one, and the rule that it follows.
"""

import sys
from pathlib import Path

import stickslip as ss

file = Path(sys.argv[0]).parent / "records" / "staggered_grid.csv"  # beside this script
study = ss.studies.judge_series(file, "fig4-loop")
print(study.verdicts)
print(study.shocks[["exact_time", "time", "delay", "size"]].round(3).to_string(index=False))

# %%
# Slip begins at the right time and with the right jump, and stops 0.9 s early, where no rule stops. The distances say how far the
# path is from each rule's, as a share of the distance from that to the next: a series below 1/8 follows the rule.

misses = study.table.filter(like="miss_").iloc[0]
print(misses.round(2).to_string())
study.plot()
