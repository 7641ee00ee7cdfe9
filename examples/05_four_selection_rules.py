"""
Four selection rules
====================

Where several slip rates solve the contact equation, a rule decides. The slab of Figure 6 is pulled for 480 years under each of
the four built-in rules. They agree on the first event, and differ in the time of the second.

You learn to choose a rule, to see whether it mattered in a run, and that centuries of rest cost no computing time.
"""

from dataclasses import replace

from matplotlib import pyplot

import stickslip as ss

slab = ss.scenarios["fig6-slab"].problem
waits = {}
for rule in ("perfect-delay", "minimal", "maxwell", "maximal"):
    run = ss.simulate(replace(slab, selection=rule), "480 years")
    waits[rule] = (run.events.start[1] - run.events.end[0]) / ss.YEAR
    print(f"{rule:14} first event {run.slip(12.0):.4f} m, second after {waits[rule]:.4f} years")

# %%
# Perfect delay and the minimal rule let the contact rest up to the static strength; Maxwell's rule of equal areas and the
# maximal rule give up rest earlier, because a faster solution exists already.

figure, axes = pyplot.subplots(figsize=(6.4, 3.4), layout="constrained")
axes.barh(list(waits), list(waits.values()), color=["C0", "C0", "C1", "C2"])
axes.invert_yaxis()
axes.set(xlabel="years of rest between the first two events", title="The same equations, the same constants, four rules")

# %%
# Every run says what the rule did to it.

print(run.selection_note)
