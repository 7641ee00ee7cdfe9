"""
Can you trust a numerical scheme?
=================================

One problem, one friction law, one mesh, and several answers. The load of this slab passes between the folds of the contact
equation, where rest and slip are both solutions. Each scheme takes one of them.

You learn to compare numerical schemes with the exact solution of every selection rule, and to see which rule each follows.
"""

import stickslip as ss

# %%
# All four searches solve the same equation at the contact. They differ in where they look for its root.

for search in ("stick-first", "continue", "newton", "fastest"):
    study = ss.studies.schemes("fig4-loop", scheme="characteristics", cells=[100], search=search)
    print(f"{search:12} follows {study.verdicts['characteristics']}")

# %%
# Implicit steps give the contact another effective impedance than the slab has. Where the contact then tries rest first, it stops
# between the loads of two rules, and a finer mesh does not change that.

study = ss.studies.schemes("fig4-loop", scheme=["characteristics", "backward-euler", "hht", "sbp4"], cells=[25, 50, 100])
print(study.table[["scheme", "cells", "final_slip", "arrest", "rule"]].round(3).to_string(index=False))
study.plot()
