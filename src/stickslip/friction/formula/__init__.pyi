# What others take from friction.formula. Each name is imported when it is first used; all else is the room's own.

from stickslip.friction.formula.at_points import (
    AtPoints,  # What compiled code needs to follow the formulas of members from point to point.
    change_at,  # Work out the change of the formula of a member from rest to a point; return the row of `of.room` with the result.
)
from stickslip.friction.formula.bounds import (
    Enclosure,  # Bounds of a formula's Taylor coefficients by the slip rate, by interval arithmetic that includes rounding.
    # Return True if a formula is proven to be convex, or concave, over all slip rates; slips (m) and numbers as in `bounds`.
    bends_one_way,
    largest,  # Return an upper bound of the magnitude on each disc; infinite where nothing is known.
    on_discs,  # Return a formula on the discs of its variables, which broadcast; `numbers` holds the law's parameters by name.
)
from stickslip.friction.formula.differences import (
    changes,  # Return what `difference` does for points that have a rate and a member each.
    difference,  # Return mu(slip + slip_step, rate) - mu(slip, 0), and dmu/drate (s/m) at the end point.
    # Return the nodes whose every way into the formula leads to a denominator, or to an argument such as that of exp.
    harmless_overflows,
    limited,  # Return the exponentials of a formula whose exponents are limited to LARGEST_EXPONENT.
    points_of,  # Return what compiled code needs to follow formulas of members, with a row of numbers each, the slip last.
    slope_formula,  # Return the derivative of a formula by a variable, one of VARIABLES.
    tape_of_changes,  # Return formulas as a tape that says of each exponential whether its exponent is limited to LARGEST_EXPONENT.
    # Return a formula and its derivatives by slip, slip rate and each of the states, as an array with one axis more in front.
    value_and_slopes,
)
from stickslip.friction.formula.expression import (
    RATE,  # Symbol of the magnitude v of the slip rate (m/s).
    SLIP,  # Symbol of the slip u (m).
    STATES,  # Symbols of the state variables of a law: of the only one, or of the first and the second.
    VARIABLES,  # All variables of formulas.
    Expression,  # A node of a formula: an operation on other nodes, a parameter, a constant, or one of the variables.
    Parameter,  # Return the node of a named number of the law, whose value is known when the run starts.
    depends_on,  # Return True if the formula contains the variable, one of VARIABLES.
    nodes_of,  # Return every distinct node of the tree, arguments before the nodes that use them, and `root` last.
)
from stickslip.friction.formula.functions import (
    evaluate,  # Return the formula at slip u (m), slip rate v (m/s) and states, with the parameters' values by name.
)
from stickslip.friction.formula.on_cells import (
    OnCells,  # What compiled code needs to bound the formulas of members.
    enclose,  # Bound the formula of a member on a cell of slip rates (m/s); return the row of `of.room` with its coefficients.
)
from stickslip.friction.formula.operations import (
    LARGEST_EXPONENT,  # Largest exponent, dimensionless, of an exp whose overflow is harmless; larger ones are replaced by it.
    OPERATIONS,  # All operations by their names in the nodes of formulas.
    operation_of,  # Return the operation of a node that has arguments.
)
from stickslip.friction.formula.operations.enclosures import (
    add,  # Return [a, b] + [c, d].
    multiply,  # Return [a, b] times [c, d].
)
from stickslip.friction.formula.operations.operation import (
    TINIEST,  # Smallest bound of a magnitude from below.
    Scaled,  # A series that differs from that of a node by a factor, and is known earlier.
    oldest_first,  # Sort the pairs of orders in a product's recurrence so that those which need the newest coefficients come last.
    sum_of,  # Write the sum of terms, which are given oldest first: the older ones as a balanced tree, then the newest one by one.
)
from stickslip.friction.formula.operations.sets import (
    SLOPE,
    Disc,  # A disc: its real centre, its radius, and a lower bound of the magnitude of all values that the node may have in it.
)
from stickslip.friction.formula.text import (
    RESERVED,  # Names that a parameter cannot have because they mean something else in an expression.
)

__all__ = [
    "LARGEST_EXPONENT",
    "OPERATIONS",
    "RATE",
    "RESERVED",
    "SLIP",
    "SLOPE",
    "STATES",
    "TINIEST",
    "VARIABLES",
    "AtPoints",
    "Disc",
    "Enclosure",
    "Expression",
    "OnCells",
    "Parameter",
    "Scaled",
    "add",
    "bends_one_way",
    "change_at",
    "changes",
    "depends_on",
    "difference",
    "enclose",
    "evaluate",
    "harmless_overflows",
    "largest",
    "limited",
    "multiply",
    "nodes_of",
    "oldest_first",
    "on_discs",
    "operation_of",
    "points_of",
    "slope_formula",
    "sum_of",
    "tape_of_changes",
    "value_and_slopes",
]
