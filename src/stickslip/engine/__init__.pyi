# What others take from engine. Each name is imported when it is first used; all else is the room's own.

from stickslip.engine.compiled_formula import (
    CompiledFormula,  # The compiled functions of a friction formula; `size` is the number of constants they need.
    compile_formula,  # Return the compiled functions of a formula; equal formulas in problems that follow each other share them.
)
from stickslip.engine.history.history import (
    NO_LEAPS,  # Table of leaps over creep (`History.creep`) without rows.
    START,  # t = 0, the start of the run.
    Epoch,  # A moment without rounding: whole round trips (a block's are periods) since t = 0, and an offset in s.
    History,  # The pieces of a run in order of time.
    Positions,  # Times located in the history: each lies at a place xi in a piece, or in a rest that was not recorded.
    Side,  # "left" or "right": which limit is taken at a shock.
)
from stickslip.engine.history.reach import (
    SAME_REACH,  # Relative difference of two displacements that is rounding.
    # The displacement from the start of a run (m, or rad) at its end, and the largest one in size with its sign and time (s).
    Reach,
    largest_of,  # Return what the largest displacement is called where slip has this unit.
    reach_of,  # Return how far the contact has gone in a history.
    shown_slip,  # Return a slip for readers; an angle also in turns if it has one or more.
)
from stickslip.engine.history.series import (
    values_at,  # Evaluate the polynomial series[row[n]] (ascending coefficients) at x[n].
)
from stickslip.engine.history.slip_events import (
    LAST_THIRD,  # After this share of a run (1), transients from its start count as over.
    NOT_YET,  # Marks an event whose aftermath is not known within the history.
    SlipEvents,  # Slip events in order of time.
    # Return the share (1) of rest in a length of time (s), given the time of slip; a share that may be rounding counts as 0.
    rest_of,
    share_sticking,  # Return the share (1) of sticking in the last third of a run.
    time_creeping,  # Return the time (s) between two others that leaps over creep take beyond their first, recorded round trips.
    time_slipping_in,  # Return how long (s) the contact slips between two times, from the table of a history.
    # Return a table of `Turn`: the points of |slip rate| (m/s) from piece `begin` on; events begin and end at rest if they can.
    walk,
)
from stickslip.engine.history.soundness import (
    check_checkpoint,  # Refuse a checkpoint from which the engine would read or write outside its tables, or never return.
    check_history,  # Refuse a history that no run can leave.
    history_table,  # Return the table of a history from the fields of its pieces.
)
from stickslip.engine.history.status import (
    ARRAYS,  # Names of the arrays in a checkpoint.
    Checkpoint,  # Copies of everything that changes in a run, except its history (see `layout`).
    # Return the key of the code that decides the result of a run; a run that continues with other code may differ in its digits.
    engine_key,
)
from stickslip.engine.history.tables import (
    SHOCK_COLUMNS,  # Units of the columns of the table of shocks, as `names.si_unit` understands them.
    creep_note,  # Return one line on the leaps over creep, or steady or slow sliding, in a history; empty if there are none.
    creep_table,  # Return a table with one row per leap over creep; for the columns see `Solution.creep`.
    # Return the selection rule if the contact equation has several solutions at some load, slip or normal load, else "".
    rule_in_force,
    shock_columns,  # Return the columns of `shocks_table` but the last one.
    shocks_table,  # Return a table with one row per jump of the slip rate between two times (s).
)
from stickslip.engine.history.turning_points import (
    Turn,  # Hold a point along |slip rate|: where it begins, ends, turns, or crosses a threshold.
)
from stickslip.engine.on_demand import (
    lend_part,  # Write the address of a part into a run's memory, by default of the part that the engine has asked for.
)
from stickslip.engine.series.step_size import (
    quick_exp2,  # Return 2^x to 0.3 %, limited to between 2^-1000 and 2^1000.
    quick_log2,  # Return log2 |x| to 0.09, straight from its bits; -1023 for zero.
)
from stickslip.engine.session import (
    # Room beyond the largest number of pieces allowed: the engine calls a history full when it has room for fewer than 8 more.
    SPARE,
    Session,  # The options, the setup, the state and the history of a run between two calls of the engine; `ExactRun` is the run.
)
from stickslip.engine.state.layout import (
    STATES,  # Largest number of states of a law (1); there is room for as many everywhere.
    TERMS,  # Coefficients of every polynomial and series (1): the orders 0 to ORDER.
    Cause,  # Name what makes the slip rate jump.
    Floats,  # An array of float64.
    HistoryPiece,  # Hold one piece of the history: a step of the contact, with load and slip rate as polynomials in xi on [0, 1].
    Integers,  # An array of int64.
    LadderCell,  # Hold one cell of a body of layers (`waves.ladder`); loads are minus the reference strength.
    Store,  # Hold a history.
)
from stickslip.engine.waves.interface import (
    cross,  # `crossed`, inlined in kernels.
    crossed,  # Return what leaves the place towards the contact and away from it (Pa), of waves that come from there.
)

__all__ = [
    "ARRAYS",
    "LAST_THIRD",
    "NOT_YET",
    "NO_LEAPS",
    "SAME_REACH",
    "SHOCK_COLUMNS",
    "SPARE",
    "START",
    "STATES",
    "TERMS",
    "Cause",
    "Checkpoint",
    "CompiledFormula",
    "Epoch",
    "Floats",
    "History",
    "HistoryPiece",
    "Integers",
    "LadderCell",
    "Positions",
    "Reach",
    "Session",
    "Side",
    "SlipEvents",
    "Store",
    "Turn",
    "check_checkpoint",
    "check_history",
    "compile_formula",
    "creep_note",
    "creep_table",
    "cross",
    "crossed",
    "engine_key",
    "history_table",
    "largest_of",
    "lend_part",
    "quick_exp2",
    "quick_log2",
    "reach_of",
    "rest_of",
    "rule_in_force",
    "share_sticking",
    "shock_columns",
    "shocks_table",
    "shown_slip",
    "time_creeping",
    "time_slipping_in",
    "values_at",
    "walk",
]
