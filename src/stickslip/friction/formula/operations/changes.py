"""How much the nodes of a formula differ between two points, without cancellation, and their derivatives at the second one.

Each node has a row of a table: its value at the reference point, its change to the end point, its value there, and its derivative
there. The value at the end point is computed independently: reference + change would lose the digits of a value that has become
small. A rule writes the row n of a node from the rows i and j of its arguments.
"""

from __future__ import annotations

REFERENCE, STEP, VALUE, SLOPE = range(4)
"""Columns of a row."""
