"""The queue of echoes on a slab with a rigid driver: which of them will make the contact slip next, and when.

A rigid driver sends back the wave that left the contact, round trip after round trip, and adds the same ramp each time. If the
contact rests under a piece of load, the piece need not be met again before it *breaks*: before the round trip, known in advance, in
which the contact may slip under it. The pieces recorded last at each phase of the round trip are the nodes of a tree, ordered by
phase; each node knows which piece in its subtree breaks first.

The tree is a treap (Seidel & Aragon 1996, Algorithmica 16, 464). Its shape depends only on the pieces in it, not on the order of
their insertion, so that a resumed run builds the same tree. During a round trip there are two trees: pieces already passed
(`counts.behind`), and pieces yet to be met (`counts.ahead`).
"""

from __future__ import annotations

import math

from stickslip.engine.contact.contact_equation import limit_towards, rest_limit
from stickslip.engine.contact.far_end import is_rigid
from stickslip.engine.series.polynomial import copy, extremes, fill, mean_of, restrict
from stickslip.engine.state.layout import NEVER, TERMS, EchoNode, HistoryPiece, Integers, Task
from stickslip.engine.state.workspace import Run, borrow
from stickslip.engine.waves.merged_creep import plan_group
from stickslip.foundation.arrays import Integers1
from stickslip.foundation.kernels.kernels import entry, kernel
from stickslip.foundation.kernels.memory.addresses import bits_of

NO_PIECE = -1
"""Index of no piece and of an empty tree."""
LONGEST_SEARCH = 4096
"""At most this many round trips (1) are tried one by one: near 2^62, floats are 512 to 1024 apart."""
NEARLY = 2e-15
"""A piece is met when its load is within this share of the reference strength (1) of breaking, so that rounding never makes it too
late."""
MOMENT_OF_REST = 1e-6
"""A contact counts as sliding in spite of rests up to this share of a round trip (1): a swing of its slip rate may touch rest."""
MANY_PIECES = 1000
"""So many pieces (1) of creep in a round trip count as another one before the first look at leaps."""
LEAST_PIECES = 16
"""The trees pay off if a round trip with slip has at least this many pieces (1); at most one in `LEAST_PIECES // 4` may slip."""


# ---- trees ------------------------------------------------------------------------------------------------------------------


@kernel
def sooner(nodes: EchoNode, ramp: float, a: int, b: int, way: int) -> bool:
    """Return True if piece a breaks before piece b, forwards (way 1) or backwards (-1), under a ramp (Pa per round trip)."""
    higher = nodes[a].high - nodes[b].high if way > 0 else nodes[a].low - nodes[b].low
    return higher > way * ramp * (nodes[a].trip - nodes[b].trip)


@kernel
def settle(nodes: EchoNode, ramp: float, n: int) -> None:
    """Set the pieces that break first in the subtree of node n, from those of its children."""
    up, down = n, n
    for child in (nodes[n].left, nodes[n].right):
        if child != NO_PIECE:
            if sooner(nodes, ramp, nodes[child].first_up, up, 1):
                up = nodes[child].first_up
            if sooner(nodes, ramp, nodes[child].first_down, down, -1):
                down = nodes[child].first_down
    nodes[n].first_up, nodes[n].first_down = up, down


@kernel
def join(nodes: EchoNode, ramp: float, a: int, b: int) -> int:
    """Join two trees and return the root; all phases of tree a must lie before those of tree b."""
    if a == NO_PIECE:
        return b
    if b == NO_PIECE:
        return a
    if nodes[a].rank > nodes[b].rank:
        nodes[a].right = join(nodes, ramp, nodes[a].right, b)
        settle(nodes, ramp, a)
        return a
    nodes[b].left = join(nodes, ramp, a, nodes[b].left)
    settle(nodes, ramp, b)
    return b


@kernel
def split(nodes: EchoNode, ramp: float, n: int, phase: float) -> tuple[int, int]:
    """Split tree n and return the roots of two: the pieces that begin before a phase (s), and the others."""
    if n == NO_PIECE:
        return NO_PIECE, NO_PIECE
    if nodes[n].phase < phase:
        before, behind = split(nodes, ramp, nodes[n].right, phase)
        nodes[n].right = before
        settle(nodes, ramp, n)
        return n, behind
    before, behind = split(nodes, ramp, nodes[n].left, phase)
    nodes[n].left = behind
    settle(nodes, ramp, n)
    return before, n


@kernel
def without_first(nodes: EchoNode, ramp: float, n: int) -> int:
    """Remove the first piece from tree n and return the root."""
    if nodes[n].left == NO_PIECE:
        return nodes[n].right
    nodes[n].left = without_first(nodes, ramp, nodes[n].left)
    settle(nodes, ramp, n)
    return n


@kernel
def first_of(run: Run, n: int) -> int:
    """Return the first piece in tree n, in order of phase, or NO_PIECE."""
    for _ in range(run.counts.length):
        if n == NO_PIECE or run.echoes[n].left == NO_PIECE:
            break
        n = run.echoes[n].left
    return n


@kernel
def rank(phase: float, trip: int) -> int:
    """Return a pseudorandom number that depends on phase and trip alone (finalizer of MurmurHash3, public domain, A. Appleby)."""
    h = bits_of(phase) ^ (trip * 0x5851F42D4C957F2D)
    h = (h ^ ((h >> 33) & 0x7FFFFFFF)) * -0x00AE502812AA7333
    h = (h ^ ((h >> 33) & 0x7FFFFFFF)) * -0x3B314601E57A13AD
    return h ^ ((h >> 33) & 0x7FFFFFFF)


# ---- when a piece breaks ----------------------------------------------------------------------------------------------------


@kernel
def room(run: Run, n: int, way: int, limit: float) -> float:
    """Return the distance (Pa) of the echo of piece n from the limit that ends rest, without the ramp.

    `way` is 1 for slip forwards, -1 for slip backwards; `limit` (Pa) is measured from the reference strength.
    """
    top = run.echoes[n].high if way > 0 else run.echoes[n].low - 2.0 * run.params.reference
    held = limit if way > 0 else limit_towards(run, way, limit)
    return held - NEARLY * abs(run.params.reference) - top


@kernel
def breaks(run: Run, n: int, way: int, limit: float, trip: int) -> bool:
    """Return True if the contact may slip in a direction under the echo of piece n in round trip `trip`."""
    if way < 0 and run.counts.one_way == 1:
        return False
    return way * run.params.ramp * (trip - run.echoes[n].trip) > room(run, n, way, limit)


@kernel
def any_breaks(run: Run, n: int, limit: float, trip: int) -> bool:
    """Return True if the contact may slip under any piece of tree n in round trip `trip`, in either direction."""
    forwards = breaks(run, run.echoes[n].first_up, 1, limit, trip)
    return forwards or breaks(run, run.echoes[n].first_down, -1, limit, trip)


@kernel
def first_to_break(run: Run, n: int, limit: float, trip: int) -> int:
    """Return the first piece of tree n, in order of phase, that may break in round trip `trip`, or NO_PIECE."""
    if n == NO_PIECE or not any_breaks(run, n, limit, trip):
        return NO_PIECE
    for _ in range(run.counts.length):
        left = run.echoes[n].left
        if left != NO_PIECE and any_breaks(run, left, limit, trip):
            n = left
        elif breaks(run, n, 1, limit, trip) or breaks(run, n, -1, limit, trip):
            return n
        else:
            n = run.echoes[n].right
    return NO_PIECE


@kernel
def next_trip(run: Run, n: int, limit: float) -> int:
    """Return the next round trip when any piece of tree n may break, or NEVER.

    The quotient of floats may be early by rounding: the search from there on ends after LONGEST_SEARCH round trips. To meet a piece
    too early is no fault.
    """
    coming = run.counts.trip + 1
    if any_breaks(run, n, limit, coming):
        return coming
    way = 1 if run.params.ramp > 0.0 else -1
    growth = abs(run.params.ramp) if way > 0 or run.counts.one_way == 0 else 0.0
    first = run.echoes[n].first_up if way > 0 else run.echoes[n].first_down
    trips = math.floor(room(run, first, way, limit) / growth) if growth > 0.0 else math.inf
    if not trips < 4e18:
        return NEVER
    trip = max(run.echoes[first].trip + int(trips), coming)
    for _ in range(LONGEST_SEARCH):
        if breaks(run, first, way, limit, trip):
            break
        trip += 1
    return trip


# ---- a round trip -----------------------------------------------------------------------------------------------------------


@kernel
def leave_out_ends(run: Run, piece: HistoryPiece) -> None:
    """If short pieces are lumped, cut `shortest` off both ends of run.trial, the echo of a piece.

    Slip only near an end would be too short to be resolved. If nothing would be left, the load becomes its mean in time.
    """
    width = piece.phase_to - piece.phase_from
    share = run.params.shortest / width if run.counts.lumps == 1 else 0.0
    if share >= 0.5:
        mean = mean_of(run.trial, piece.speed, piece.bend, width)
        fill(run.trial, 0.0)
        run.trial[0] = mean
    elif share > 0.0:
        restrict(run.trial, share, 1.0 - 2.0 * share, run.spare)
        copy(run.spare, run.trial, TERMS)


@kernel
def add(run: Run, n: int) -> None:
    """Add piece n to the tree of pieces that the round trip has passed, after all pieces in it."""
    node, piece = run.echoes[n], run.history[n]
    load, rate = piece.load, piece.rate
    for k in range(TERMS):
        run.trial[k] = load[k] - 2.0 * run.params.impedance * rate[k]
    leave_out_ends(run, piece)
    lowest, node.high = extremes(run.trial)
    node.phase, node.low = piece.phase_from, -lowest
    node.left = node.right = NO_PIECE
    node.first_up = node.first_down = n
    node.trip = piece.trip
    node.rank = rank(node.phase, node.trip)
    run.counts.behind = join(run.echoes, run.params.ramp, run.counts.behind, n)


@kernel
def add_new(run: Run) -> None:
    """Add the pieces that were recorded since the last call."""
    for n in range(run.counts.new_from, run.counts.length):
        add(run, n)
    run.counts.new_from = run.counts.length


@kernel
def pass_to(run: Run, n: int) -> None:
    """Move the pieces before piece n to the tree of those that have been passed, and take piece n out of the tree ahead."""
    phase = run.echoes[n].phase
    before, rest = split(run.echoes, run.params.ramp, run.counts.ahead, phase)
    run.counts.behind = join(run.echoes, run.params.ramp, run.counts.behind, before)
    run.counts.ahead = without_first(run.echoes, run.params.ramp, rest)
    if run.counts.new_from == run.counts.length:
        run.state.new_since = phase
    run.state.taken_to = run.history[n].phase_to


@kernel
def goes_on(run: Run) -> bool:
    """Return True if the very next piece must be met: the contact slips, or came to rest exactly where the last piece ended."""
    return run.counts.mode != 0 or run.history[run.counts.length - 1].mode != 0


@kernel
def next_echo(run: Run) -> int:
    """Take out and return the piece of the history whose echo must be met next in this round trip, or NO_PIECE."""
    if goes_on(run):
        source = first_of(run, run.counts.ahead)
    else:
        add_new(run)
        source = first_to_break(run, run.counts.ahead, rest_limit(run, 1), run.counts.trip)
    if source != NO_PIECE:
        pass_to(run, source)
        plan_group(run, source)
        for n in range(source + 1, source + run.counts.merged):
            run.counts.ahead = without_first(run.echoes, run.params.ramp, run.counts.ahead)
            run.state.taken_to = run.history[n].phase_to
    return source


@kernel
def start_of_slide(run: Run) -> int:
    """Return the first piece of the round trip that ends, if the contact has slipped throughout it, else NO_PIECE."""
    n, rest = run.counts.length - 1, MOMENT_OF_REST * run.params.round_trip_time
    if run.history[n].phase_to != run.params.round_trip_time:  # the last echoes were not met, for the contact rests under them
        return NO_PIECE
    while n >= 0 and run.history[n].trip == run.counts.trip:
        piece = run.history[n]
        rest -= piece.phase_to - piece.phase_from if piece.mode == 0 else 0.0
        if rest < 0.0:
            return NO_PIECE
        if piece.phase_from == 0.0:
            return n
        if n > 0 and run.history[n - 1].phase_to != piece.phase_from:
            return NO_PIECE
        n -= 1
    return NO_PIECE


@kernel
def end_trip(run: Run) -> None:
    """Close a round trip, and go to the next one that may let the contact slip; set `is_locked` if there is none."""
    run.counts.merged = 0
    if run.counts.creep_in > 0:
        first = start_of_slide(run)
        beside_rest = is_slip_law(run) and run.counts.moved == 1
        run.counts.creep_in -= patience_spent(run) if beside_rest else 1 if first != NO_PIECE else 0
        if run.counts.creep_in == 0:
            if not beside_rest:
                leave_queue(run, first)
                return
            run.counts.pause_at = run.counts.trip + 1
    run.counts.previous_from, run.counts.previous_to = run.counts.trip_from, run.counts.length
    add_new(run)
    whole = join(run.echoes, run.params.ramp, run.counts.behind, run.counts.ahead)
    trip = run.counts.trip + 1 if goes_on(run) else next_trip(run, whole, rest_limit(run, 1))
    settled = run.params.ramp == 0.0 and run.counts.moved == 0
    run.counts.is_locked = 1 if trip == NEVER or settled else 0
    run.counts.trip = trip
    run.counts.ahead, run.counts.behind = whole, NO_PIECE
    run.state.new_since = run.state.taken_to = 0.0
    run.counts.moved = 0
    run.counts.trip_from = run.counts.length


@kernel
def is_slip_law(run: Run) -> bool:
    """Return True if friction depends on slip alone, and the contact has no mass: slip beside rest is then creep."""
    return run.counts.is_algebraic == 0 and run.counts.has_inertia == 0 and run.counts.states == 0


@kernel
def patience_spent(run: Run) -> int:
    """Return how much of the patience before a look at leaps a round trip of creep takes: more if it has very many pieces."""
    return min(1 + (run.counts.length - run.counts.trip_from) // MANY_PIECES, run.counts.creep_in)


@kernel
def leave_queue(run: Run, first: int) -> None:
    """Meet all echoes again after a round trip of slip, whose first piece is given, and pause for a look at leaps."""
    run.counts.sparse, run.counts.behind, run.counts.ahead = 0, NO_PIECE, NO_PIECE
    run.counts.trip += 1
    run.counts.pause_at = run.counts.trip
    run.counts.previous_from, run.counts.previous_to, run.counts.trip_from = first, run.counts.length, run.counts.length
    run.counts.source = run.counts.moved = run.counts.trips_at_rest = run.counts.is_locked = 0


@kernel
def worth_building(run: Run) -> bool:
    """Return True if only echoes that break should be met from here on.

    Conditions: the round trip was at rest, or almost so if it had many pieces; the body is a slab with a rigid driver; the loading
    is steady; the law knows rest and has no state variable; no pause for leaps is due, but for those over creep beside rest.
    """
    if not is_rigid(run) or run.counts.states > 0:
        return False
    if run.counts.sticks == 0 or run.counts.varies == 1 or (run.counts.pause_at != NEVER and not is_slip_law(run)):
        return False
    slipping, pieces = 0, run.counts.length - run.counts.trip_from
    for n in range(run.counts.trip_from, run.counts.length):
        slipping += 1 if run.history[n].mode != 0 else 0
    return slipping == 0 or (pieces >= LEAST_PIECES and slipping <= pieces // (LEAST_PIECES // 4))


@kernel
def build_queue(run: Run) -> None:
    """Meet only echoes that break from here on, and build the tree from the pieces of the round trip just past."""
    run.counts.sparse, run.counts.new_from = 1, run.counts.trip_from
    run.counts.behind = run.counts.ahead = NO_PIECE
    end_trip(run)


@entry
def rebuild_queue(table: Integers1, pieces: Integers1, past: int) -> None:
    """Build the trees of a resumed run from the given pieces, which are in order of phase.

    The present round trip has passed the first `past` of them. `table` comes from `workspace.lend`.
    """
    run = borrow(table)
    run.counts.behind = NO_PIECE
    for k in range(past, len(pieces)):
        add(run, pieces[k])
    run.counts.ahead, run.counts.behind = run.counts.behind, NO_PIECE
    for k in range(past):
        add(run, pieces[k])


@kernel
def in_order(nodes: EchoNode, n: int, out: Integers, count: int) -> int:
    """Write the pieces of tree n, in order of phase, behind the first `count` entries, and return how many entries there are."""
    if n == NO_PIECE:
        return count
    count = in_order(nodes, nodes[n].left, out, count)
    out[count] = n
    return in_order(nodes, nodes[n].right, out, count + 1)


@entry
def write_ahead(table: Integers1, out: Integers1) -> int:
    """Write the pieces whose echoes are yet to be met, in order of phase, and return their number. `table` is as above."""
    run = borrow(table)
    return in_order(run.echoes, run.counts.ahead, out, 0)


@entry
def echo_queue(memory: int, task: int, number: float) -> float:
    """Return the next piece whose echo must be met, close a round trip, or build the queue."""
    if task == Task.NEXT_ECHO:
        return float(next_echo(borrow(memory)))
    if task == Task.END_TRIP:
        end_trip(borrow(memory))
    else:
        build_queue(borrow(memory))
    return 0.0
