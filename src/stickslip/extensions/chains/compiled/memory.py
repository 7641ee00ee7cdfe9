"""What the compiled solver of chains reads and writes: numbers of a chain, its state, room for a step, and rows that are kept."""

from __future__ import annotations

from typing import NamedTuple

from stickslip.foundation.arrays import Floats1, Floats2, Integers1, Integers2

REST, FORWARD, WITHOUT_FRICTION, BACKWARD = 0, 1, 2, -1
"""Modes of a block: at rest, in slip forward or backward, or without friction, so that it never rests."""
ONSET, ARREST, TURN, KNOT = range(4)
"""Kinds of changes: slip begins; it ends; it goes on in the other direction at once; the law passes a knot."""
DONE, GOES_ON, HANGS, NOT_FINITE = range(4)
"""Why the solver returns: the time is reached; its budget or its room is used up; time does not advance; a number is not finite."""

ORIGIN, SINCE = range(2)
"""Places in `now`: time is the sum of these two (s), and the second counts from the last onset after rest."""
PULL, HEAT, DASHPOT, WORK = range(2, 6)
"""The force of the driver (N), and energies since t = 0 (J): heat of friction, heat of dashpots, work of the driver."""
LARGEST_RATE, FIRST_BLOCK, HEAT_BEFORE, DASHPOT_BEFORE, WORK_BEFORE, SPRINGS_BEFORE, EVENT_START, IN_EVENT = range(6, 14)
"""Of the event in progress: the largest slip rate (m/s), its first block, the energies (J) and the time (s) at its start, and 1."""
COUNT_OF_CHANGES, COUNT_OF_STEPS, BLOCK_STEPS, EVENTS, LAST_STEP, DEFECT, RESIDUAL = range(14, 21)
"""Counts of changes, steps, blocks that moved in them, and events; the length of the last step (s); the largest remainder of a
series as a share of the motion in its step (1), under laws that are not straight the largest bound of the force that an equation
lacks in a step, as a share of the strength (1); and the largest force that the equation of a block lacks at the end of a step, as a
share of its strength (1)."""
NUMBERS_NOW = 21

SLIP, RATE_NOW, COUNTED, DUE, STRENGTH, SLIP_BEFORE = range(6)
"""Rows of numbers of blocks: slip (m), slip rate (m/s), slip that the law counts (m), the time (s) when a block that nothing
but the driver loads begins to slip (inf for any other), its strength (N) at rest, and its slip (m) before the event."""
ROWS_OF_BLOCKS = 6
MODE, PIECE, AT_STRENGTH, SLIPPED = range(4)
"""Rows of whole numbers of blocks: the mode; the piece of the law; where it is exactly at its strength by definition (1, -1 or 0);
and 1 if it has slipped in the event in progress."""
WHOLE_ROWS_OF_BLOCKS = 4

CHANGE_TIME, CHANGE_SINCE, CHANGE_BLOCK, CHANGE_KIND, CHANGE_SLIP = range(5)
"""Columns of a change: time (s), time since the first onset of its event (s), block, kind, slip (m)."""
EVENT_TIME, EVENT_BLOCK, EVENT_SIZE, EVENT_MOMENT, EVENT_DURATION, EVENT_RATE = range(6)
"""Columns of an event: time (s), first block, number of blocks that slipped, sum of their slip (m), duration (s), largest rate."""
EVENT_HEAT, EVENT_DASHPOT, EVENT_WORK, EVENT_SPRINGS_BEFORE, EVENT_SPRINGS_AFTER = range(6, 11)
"""Its energies (J)."""
CHANGE_COLUMNS, EVENT_COLUMNS = 5, 11
COUNTS_NET, HEALS, STRAIGHT = range(3)
"""Columns of `Laws.rules`."""


class Springs(NamedTuple):
    """Rows of neighbours (see `couplings.Couplings`)."""

    starts: Integers1
    neighbours: Integers1
    springs: Floats1
    walls: Floats1


class Blocks(NamedTuple):
    """The numbers of each block: kg, N/m, N, N s/m, and which law it has."""

    mass: Floats1
    stiffness: Floats1
    normal: Floats1
    damping: Floats1
    law: Integers1


class Laws(NamedTuple):
    """The laws, piece by piece of slip, from one knot (m) to the next.

    Where a law is straight in slip, mu = level + slope times the counted slip, less the reference (m). Any other law has functions
    of its formula at addresses, and mu is the level plus what they return. `rules` has for each law 1 if it counts net slip, 1 if
    it forgets slip at an arrest, and 1 if it is straight; `excess` is the step (1) from sliding to static friction.
    """

    knots: Floats2
    levels: Floats2
    slopes: Floats2
    references: Floats2
    excess: Floats1
    rules: Integers2
    values_at: Integers2
    jets_at: Integers2
    radii_at: Integers2
    constants_at: Integers2


class ChainNumbers(NamedTuple):
    """A chain as numbers.

    `fastest` (1/s) bounds the frequency of any of its motions, `all_stiffness` (N/m) is that of all springs to the driver, and
    `all_straight` is 1 if all laws are straight in slip.
    """

    springs: Springs
    blocks: Blocks
    laws: Laws
    pull_rate: float
    forward_only: int
    fastest: float
    all_stiffness: float
    all_straight: int


class Now(NamedTuple):
    """The state of a chain: all that decides how it goes on."""

    now: Floats1
    blocks: Floats2
    whole: Integers2


class StepRoom(NamedTuple):
    """Room for a step: series of blocks, places of changes in the step, and lists of blocks, each with its length in `counts`."""

    series: Floats2
    places: Floats1
    kinds: Integers1
    near: Integers1
    moving: Integers1
    watched: Integers1
    slipped: Integers1
    changed: Integers1
    counts: Integers1
    span: Floats1
    """The unit of time (s) of the series, first a guess, and then the length of the step; and under laws that are not straight a
    bound of the force that a block's equation lacks in the step, as a share of its strength (1)."""


MOVING, WATCHED, HAVE_SLIPPED, FIRST_DUE, CHANGE_ROWS, EVENT_ROWS, SAMPLES = range(7)
"""Places in `counts`: lengths of the lists, the block that is due first, rows that are written, samples that are taken."""
NUMBER_OF_COUNTS = 7


class KeptRows(NamedTuple):
    """Rows that are written: changes if there is room for any, events, and samples of slip and rate at given times (s)."""

    changes: Floats2
    events: Floats2
    sample_times: Floats1
    sampled_slip: Floats2
    sampled_rate: Floats2


class Limits(NamedTuple):
    """How far to go: a time (s), 1 if the last step is cut there, and the number of steps of blocks."""

    until: float
    is_cut: int
    budget: int
