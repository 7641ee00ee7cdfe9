"""Loading that varies in time: how it adds to a piece of load and cuts it, and how long a contact at rest withstands it.

The inflow F (slab: Pa, block: N/s) is linear in time between breaks, or a parabola where the ground under a slab moves, plus a
tone. A piece of load is cut where a new segment of F arrives; from then on the break is an edge between pieces, and so are its
echoes. The load at rest grows by F from one round trip to the next on a slab, and by the integral of F on a block. As long as only
the tone changes over some round trips, both sums are closed forms in F at their mean time.
"""

from __future__ import annotations

import math

from stickslip.engine.contact.contact_equation import is_barred, limit_towards
from stickslip.engine.contact.far_end import has_faded, is_rigid, sent_back, was_rigid
from stickslip.engine.contact.pieces import phase_at, span_of_load, xi_at
from stickslip.engine.contact.pressing import couple, is_pressing, press, press_ahead, pressing_at, tone_series
from stickslip.engine.series.polynomial import RECIPROCAL, copy, fill, restrict, total
from stickslip.engine.state.layout import NEVER, TERMS, Task
from stickslip.engine.state.workspace import Run, borrow
from stickslip.engine.waves.driver_at_rest import trips_of_machine
from stickslip.engine.waves.merged_pieces import gather, plan_merging
from stickslip.engine.waves.winding_up import wind_up
from stickslip.foundation.kernels.kernels import entry, kernel
from stickslip.foundation.kernels.memory.addresses import call_part
from stickslip.foundation.phasors import dirichlet

AT_EDGE = 1e-13
"""A break of the loading lies on the edge of a piece if it is closer to it than this share of a round trip (1), by rounding."""
BISECTIONS = 64
"""Largest number of bisections (1) of a number of round trips, which is at most 2^63."""


@kernel
def take_loading(run: Run) -> None:
    """Cut the piece of load at the next break of the loading, and add the loading to it."""
    begin = run.state.taken
    phase = run.state.taken_to_phase if begin > 0.0 else run.state.phase_from
    end, phase_to = 1.0, run.state.phase_to
    change = next_change(run)
    if change < phase_to - AT_EDGE * run.params.round_trip_time:
        end, phase_to = min(xi_at(run, change), 1.0), change
    if begin > 0.0 or end < 1.0:
        cut(run, begin, end, phase, phase_to)
    if run.counts.cells > 0:
        if run.counts.driven == 1:
            kept = call_part(run.driver, run, Task.DRIVE, 0.0)
            if kept < 1.0:
                end, phase_to = begin + kept * (end - begin), run.state.phase_to
        fill(run.load, 0.0)
        if run.counts.driven == 0:
            add_loading(run)
        call_part(run.ladder, run, Task.SEND_IN, 0.0)
    elif run.counts.driven == 0:
        add_loading(run)
    elif run.counts.trip > 0 or run.state.phase_from >= 0.5 * run.params.round_trip_time or run.params.damper_pace > 0.0:
        kept = call_part(run.driver, run, Task.DRIVE, 0.0)
        if kept < 1.0:
            end, phase_to = begin + kept * (end - begin), run.state.phase_to
    if run.counts.given > 0:
        press(run, run.state.phase_from)
    run.state.taken, run.state.taken_to_phase = (end, phase_to) if end < 1.0 else (0.0, 0.0)
    run.counts.source += max(run.counts.merged, 1) if end == 1.0 else 0


@kernel
def enter_segment(run: Run) -> bool:
    """Enter the segment of the loading that has arrived where the piece of load begins; return True if the loading jumps there."""
    phase = run.state.taken_to_phase if run.state.taken > 0.0 else run.state.phase_from
    jumps, tie = False, AT_EDGE * run.params.round_trip_time
    before = pressing_at(run, phase, 0.0)[0] if run.counts.given > 0 else 0.0
    for _ in range(run.segments):
        if not next_change(run) <= phase + tie:
            break
        run.counts.segment += 1
        run.params.reflection = run.loading[run.counts.segment].reflection
        run.counts.trips_at_rest = -1  # the last round trip at rest does not predict the next one
        jumps = jumps or run.loading[run.counts.segment].jump == 1.0
    if run.counts.given > 0:
        if jumps:
            couple(run, before, pressing_at(run, phase, 0.0)[0])
        follows = run.counts.folds_follow_slip == 1 or (run.counts.is_algebraic == 1 and is_pressing(run))
        run.counts.folds_move = 1 if follows else 0
    return jumps


@kernel
def next_change(run: Run) -> float:
    """Return the phase (s) when the next segment arrives; inf if in a later round trip, -inf if in an earlier one."""
    following = run.counts.segment + 1
    if following >= run.segments or run.loading[following].trip > run.counts.trip:
        return math.inf
    return run.loading[following].offset if run.loading[following].trip == run.counts.trip else -math.inf


@kernel
def cut(run: Run, begin: float, end: float, phase: float, phase_to: float) -> None:
    """Restrict the piece of load to xi from `begin` to `end`, whose phases (s) are `phase` and `phase_to`."""
    width = end - begin
    if run.counts.cells > 0:
        run.state.xi = begin  # a part takes one number only; the place is set anew before the contact meets the piece
        call_part(run.ladder, run, Task.CUT_WAVES, end)
    restrict(run.load, begin, width, run.spare)
    copy(run.spare, run.load, TERMS)
    run.state.speed = (run.state.speed + 2.0 * run.state.bend * begin) * width
    run.state.bend *= width * width
    run.state.phase_from, run.state.phase_to = phase, phase_to


@kernel
def shorten(run: Run, share: float) -> None:
    """Keep only the given share of the piece of load, from its start."""
    if share < 1.0:
        cut(run, 0.0, share, run.state.phase_from, phase_at(run, share))


@kernel
def add_loading(run: Run) -> None:
    """Add to the piece of load what the driver has sent since its source was recorded."""
    trip = float(run.counts.trip)
    if run.counts.is_block == 1:
        pull_block(run)
    elif trip > 0.0 or run.state.phase_from >= run.params.inflow_from:
        leaped = 0.0
        if trip > 0.0 and was_rigid(run):
            leaped = trip - 1.0 - run.history[run.counts.echo_of].trip
        if leaped > 0.0:
            add_inflow(run, leaped, trip - 0.5 * (leaped + 1.0), run.counts.trip_segment, -sent_back(run))
        add_inflow(run, 1.0, trip, run.counts.segment, 1.0)


@kernel
def add_inflow(run: Run, trips: float, mean_trip: float, segment: int, share: float) -> None:
    """Add to a slab's load the inflow of `trips` round trips, of mean index `mean_trip`, at the phases of the piece of load.

    `share` (1) is the factor that this inflow has gained since.
    """
    since = (mean_trip - run.loading[segment].trip) * run.params.round_trip_time + (
        run.state.phase_from - run.loading[segment].offset
    )
    slope = trips * run.loading[segment].slope
    run.load[0] += share * (trips * run.loading[segment].value + slope * since)
    slope *= share
    run.load[1] += slope * run.state.speed
    run.load[2] += slope * run.state.bend
    if run.loading[segment].curve != 0.0:  # no round trips are leaped over then
        add_curve(run, run.loading[segment].curve, since)
    if run.loading[segment].tone != 0.0:
        weight = share * dirichlet(trips, run.params.tone_frequency * run.params.round_trip_time)
        time = mean_trip * run.params.round_trip_time + run.state.phase_from
        tone_series(run, weight * run.loading[segment].tone, run.loading[segment].tone_phase, time)
        for k in range(TERMS):
            run.load[k] += run.spare[k]


@kernel
def add_curve(run: Run, curve: float, since: float) -> None:
    """Add curve t^2 to a slab's load, where t is the time since the segment began: `since` (s) at the start of the piece."""
    speed, bend = run.state.speed, run.state.bend
    run.load[0] += curve * since * since
    run.load[1] += curve * 2.0 * since * speed
    run.load[2] += curve * (2.0 * since * bend + speed * speed)
    run.load[3] += curve * 2.0 * speed * bend
    run.load[4] += curve * bend * bend


@kernel
def pull_block(run: Run) -> None:
    """Set a block's load: its value at the end of the history, plus what pull and ground have added to it since."""
    n = run.counts.length - 1
    if n >= 0:
        run.load[0] = total(run.history[n].load)
        trips = float(run.counts.trip - run.history[n].trip - 1)
        if trips > 0.0:
            run.load[0] += pulled_in_trips(run, trips)
    run.load[0] += step_here(run)
    segment, pace = run.counts.segment, run.state.speed
    since = (run.counts.trip - run.loading[segment].trip) * run.params.round_trip_time
    since += run.state.phase_from - run.loading[segment].offset
    slope = run.loading[segment].slope
    run.load[1] += pace * (run.loading[segment].value + slope * since)
    run.load[2] += 0.5 * pace * pace * slope
    if run.params.winding != 0.0:
        wind_up(run, since)
    if run.params.play > 0.0 and run.counts.side == 0:
        call_part(run.play, run, Task.LET_GO, 0.0)
    if run.loading[segment].tone != 0.0:
        time = run.counts.trip * run.params.round_trip_time + run.state.phase_from
        tone_series(run, run.loading[segment].tone, run.loading[segment].tone_phase, time)
        for k in range(1, TERMS):
            run.load[k] += pace * RECIPROCAL[k] * run.spare[k - 1]


@kernel
def step_here(run: Run) -> float:
    """Return by how much (N) a block's load jumps where the piece of load begins: the steps of the segments entered there."""
    total_step, tie = 0.0, AT_EDGE * run.params.round_trip_time
    for n in range(run.counts.segment, -1, -1):
        one = run.loading[n]
        if one.trip != run.counts.trip or not abs(one.offset - run.state.phase_from) <= tie:
            break
        total_step += one.step
    return total_step


@kernel
def pulled_in_trips(run: Run, trips: float) -> float:
    """Return the force (N) that the pull adds to a block's spring in a number of round trips at rest before this one."""
    segment, lasting = run.counts.trip_segment, trips * run.params.round_trip_time
    middle = (run.counts.trip - 0.5 * trips) * run.params.round_trip_time
    since = (run.counts.trip - 0.5 * trips - run.loading[segment].trip) * run.params.round_trip_time - run.loading[segment].offset
    gained = lasting * (run.loading[segment].value + run.loading[segment].slope * since)
    if run.loading[segment].tone != 0.0:
        frequency = run.params.tone_frequency
        swing = math.sin(frequency * middle + run.loading[segment].tone_phase)
        gained += run.loading[segment].tone * 2.0 / frequency * math.sin(0.5 * frequency * lasting) * swing
    return gained


# ---- rest -------------------------------------------------------------------------------------------------------------------


@kernel
def trips_withstood(run: Run, limit: float) -> int:
    """Return for how many whole round trips a contact at rest stays at rest, up to the next break of the loading.

    `limit` is the load (Pa or N, minus the reference strength) that ends rest. NEVER means that rest never ends.
    """
    segment = run.counts.segment
    following = segment + 1
    room = run.loading[following].trip - run.counts.trip - 1.0 if following < run.segments else float(NEVER)
    if is_pressing(run) or (run.counts.given > 0 and segment != run.counts.trip_segment):
        return 0  # the round trip just past does not predict the next one
    if run.params.winding != 0.0:
        return 0  # no two periods are alike
    if run.params.play > 0.0 and call_part(run.play, run, Task.KEEPS_SIDE, 0.0) == 0.0:
        return 0
    if run.loading[segment].shakes == 1.0:
        return 0  # the work of moving ground is added up over recorded pieces, so that no round trip may be left out
    if run.counts.driven == 1:
        least, largest = span_of_load(run)
        return trips_of_machine(run, limit, room, largest, -least)
    is_dead = run.loading[segment].slope == 0.0 and run.loading[segment].tone == 0.0
    if run.counts.is_block == 0 and not is_rigid(run):
        return int(max(room, 0.0)) if is_dead and has_faded(run) else 0
    if is_dead and run.loading[segment].value == 0.0:
        return int(max(room, 0.0))
    least, largest = span_of_load(run)
    top = math.inf if is_barred(run, 1) else limit - largest
    bottom = math.inf if is_barred(run, -1) else limit_towards(run, -1, limit) + 2.0 * run.params.reference + least
    low, high = 0.0, max(room, 0.0)
    if withstands(run, high, top, bottom):
        return int(high)
    for _ in range(BISECTIONS):
        if not (high - low > 1.0 and high - low > 1e-3 * low):
            break
        middle = math.floor(0.5 * (low + high))
        if withstands(run, middle, top, bottom):
            low = middle
        else:
            high = middle
    return int(low)


@kernel
def withstands(run: Run, trips: float, top: float, bottom: float) -> bool:
    """Return True if the load will certainly grow by less than `top` and fall by less than `bottom` (Pa or N) in the next ones."""
    return growth_bound(run, trips, 1.0) < top and growth_bound(run, trips, -1.0) < bottom


@kernel
def growth_bound(run: Run, trips: float, sign: float) -> float:
    """Return a bound (Pa or N) on the growth of sign * load at rest over the next round trips, up to the given number of them."""
    segment, period, frequency = run.counts.segment, run.params.round_trip_time, run.params.tone_frequency
    begin = run.counts.trip * period
    end = begin + (trips + 2.0) * period
    since = (run.counts.trip - run.loading[segment].trip) * period - run.loading[segment].offset
    value, slope = sign * run.loading[segment].value, sign * run.loading[segment].slope
    largest = max(value + slope * since, value + slope * (since + (trips + 2.0) * period), 0.0)
    is_block = run.counts.is_block == 1
    lasting = trips * period if is_block else trips
    bound = lasting * largest
    if run.loading[segment].tone != 0.0:
        amplitude, phase = sign * run.loading[segment].tone, run.loading[segment].tone_phase
        steepest = largest_sine(frequency * begin + phase, frequency * end + phase, amplitude)
        half = abs(math.sin(0.5 * frequency * period))
        swing = 2.0 / frequency if is_block else 1.0 / half if half > 0.0 else math.inf
        bound += min(lasting * max(steepest, 0.0), abs(amplitude) * swing)
    return bound


@kernel
def largest_sine(begin: float, end: float, amplitude: float) -> float:
    """Return the largest value of amplitude sin(x) for x between two angles (rad)."""
    if amplitude < 0.0:
        return largest_sine_up(begin + math.pi, end + math.pi) * -amplitude
    return largest_sine_up(begin, end) * amplitude


@kernel
def largest_sine_up(begin: float, end: float) -> float:
    """Return the largest value of sin(x) for x between two angles (rad)."""
    peak = (math.floor((begin - 0.5 * math.pi) / (2.0 * math.pi)) + 1.0) * 2.0 * math.pi + 0.5 * math.pi
    return 1.0 if peak <= end else max(math.sin(begin), math.sin(end))


@entry
def loading_history(memory: int, task: int, number: float) -> float:
    """Serve a loading that varies: see `Task`.

    Round trips at rest count as long as the load stays below `number` (Pa or N); a normal load is written in units of `number` (in
    xi).
    """
    if task == Task.ENTER_SEGMENT:
        return 1.0 if enter_segment(borrow(memory)) else 0.0
    if task == Task.COUNT_TRIPS_AT_REST:
        return float(trips_withstood(borrow(memory), number))
    if task == Task.TAKE_LOADING:
        take_loading(borrow(memory))
    elif task == Task.GATHER_WAVES:
        gather(borrow(memory), int(number))
    elif task == Task.PLAN_MERGING:
        plan_merging(borrow(memory))
    else:
        press_ahead(borrow(memory), number)
    return 0.0
