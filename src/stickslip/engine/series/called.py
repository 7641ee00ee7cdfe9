"""The functions that lines of operations call (`Operation.called`), compiled for floats and for lanes.

Many of them are f(now) - f(reference), where now = reference + step. Near the reference they have no cancellation, and far from it
they take the values. All numbers are those of a node of a formula and have its unit.
"""

from __future__ import annotations

from numba import njit

from stickslip.engine.codegen.simd import lane_by_lane
from stickslip.engine.codegen.uncompiled import UNCOMPILED, as_python
from stickslip.friction.formula.operations import OPERATIONS

_stated = {function.__name__: function for one in OPERATIONS.values() for function in one.called}
FLOATS = {name: njit(error_model="numpy")(as_python(one) if UNCOMPILED else one) for name, one in _stated.items()}
"""The functions by their names."""
LANES = {name: lane_by_lane(one) for name, one in FLOATS.items()}
"""The same for lanes, lane by lane."""
