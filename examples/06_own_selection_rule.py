"""
A selection rule of your own
============================

A rule is a function of the resistance g and its stable branches. It returns between which loads the contact stays on each of
them. This one changes from rest to slip, and back, halfway between the two folds.

You learn to write a rule and to draw a run over its set K.
"""

import math
from dataclasses import replace

from matplotlib import pyplot

import stickslip as ss


def halfway(g, stable):
    """Leave rest, and return to it, halfway between the folds."""
    level = 0.5 * stable[0].excess_from
    return ss.selection.SelectionTable(stick_to=level, keep_from=(level,), keep_to=(math.inf,))


loop = ss.scenarios["fig4-loop"]
figure, panels = pyplot.subplots(1, 2, figsize=(9.0, 4.0), sharey=True, layout="constrained")
for axes, rule in zip(panels, ("perfect-delay", halfway), strict=True):
    run = ss.simulate(replace(loop.problem, selection=rule), loop.duration)
    run.plot.path(ax=axes)
    axes.set_title(rule if isinstance(rule, str) else "a rule of your own: halfway")
    jumps = run.shocks
    print(f"{axes.get_title()}: jumps at {jumps.time.round(4).tolist()} s to {jumps.rate_after.round(4).tolist()} m/s")

# %%
# The load rises to 85.5 MPa and falls again. Perfect delay jumps at one fold on the way up and at the other on the way down; the
# other rule jumps at one level both ways, and has no hysteresis.
