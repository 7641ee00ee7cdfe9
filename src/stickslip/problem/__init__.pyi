# What others take from problem. Each name is imported when it is first used; all else is the room's own.

from stickslip.problem import features, loading
from stickslip.problem import selection_rule as selection
from stickslip.problem.accelerogram import (
    ALL_HISTORIES,  # Every history that a scenario file may have, those of users in HISTORIES too.
    Accelerogram,  # Acceleration of the ground as it was recorded: a straight line from sample to sample, and 0 after the last one.
)
from stickslip.problem.bodies.soft_torque import (
    sent_back,  # Return the size of the share (1) that the drive sends back of a wave with a period (s).
    tuned_period,  # Return the period (s) at which inertia and integral gain of a drive cancel; NaN if it has not both.
)
from stickslip.problem.drivers.driver import (
    DRIVERS,  # What each kind of driver answers, by `Problem.driver_kind`.
    driver_impedance,  # Return how the driver of a uniform body resists a motion exp(s t) of its end.
    driver_of,  # Return what the driver of a problem answers.
    far_at_first,  # Return the stress behind the last layer, or behind a slab, at the start, minus the reference strength (Pa).
    far_excess,  # Return the default far stress, that in the slab at the start, minus the reference strength (Pa).
    inflow_of,  # Return the inflow of a problem.
    loading_rate,  # Return the initial growth rate of the load on a stuck contact (Pa/s, N/s or N m/s).
    steady_inflow,  # Return the inflow of a loading that does not vary: its value at 0 s and its growth per second.
    tone_of,  # Return the sinusoid of the loading: that of the pull or, if it has none, that of the ground.
    # Return the wave beta - 2 Z v, minus the reference strength (Pa), that leaves the contact of a slab just before the start.
    wave_before,
)
from stickslip.problem.drivers.machine import (
    pace_of,  # Return how fast (1/s) the motion of a machine may change by its own size: see `engine.waves.driver`.
    pull_of,  # Return the pull rate (m/s) of a machine, as it arrives at the contact.
    # Return the rate (m/s) that a machine tends to while the contact rests, under the loading that has arrived at times (s).
    settled_rate,
)
from stickslip.problem.equivalent_block import (
    block_for,  # Return the same problem for the slab's equivalent block, which represents 1 m^2 of contact.
)
from stickslip.problem.event_rate import (
    # Slip rate from which slip is an event by default, as a share of S (range of mu) / Z; for a block sqrt(K m) replaces Z.
    EVENT_SHARE,
    check_event_rate,  # Return the slip rate (m/s) that defines slip events, or None, which stands for the default of the problem.
    # Return the default slip rate (m/s) that defines an event: 1e-6 S (range of mu) / Z; for the block sqrt(K m) replaces Z.
    default_event_rate,
)
from stickslip.problem.fields import (
    HISTORIES_ONLY,  # Fields of a problem that are a loading history or nothing.
    INITIAL_STATES,  # Names of the initial states in a `Problem`.
    LOAD,  # Unit of a load: Pa on a slab, N on a block, N m on what turns.
    MAY_VARY,  # Fields of a problem that may be a loading history.
    STEADY,  # Initial state, or initial rate, that stands for the one of steady sliding at the pull rate.
)
from stickslip.problem.given_units import (
    # Decorate a method of what belongs to a problem: what it prints or draws is in the units in which the problem was given.
    in_given_units,
    units_given,  # Return the units in which results of a problem are shown because something of their kind was given in them.
    # Return the units in which results of several problems are shown together: those in which all with such results were given.
    units_shared,
)
from stickslip.problem.ground import (
    Ground,  # Pieces of the ground's motion: what holds where each begins, without the tone, and the constant jerk on it.
)
from stickslip.problem.inflow import (
    EDGE,  # Distance from the edge of a round trip, as a share of it, within which a break lies on the edge.
    Inflow,  # Straight segments, each with the time (s) of its arrival, plus a tone.
    breaks_of,  # Return the round trips and offsets (s) of times (s); an edge between two is offset 0 of the later.
)
from stickslip.problem.kinds import (
    BODY_KINDS,  # Each kind of body (`Body.structure`).
    DRIVER_KINDS,  # Each kind of driver (`Problem.driver_kind`): the far end of a rigid body's spring, or one of waves.
    DRIVERS_OF_WAVES,  # Each kind of driver of a body with waves.
)
from stickslip.problem.limits import (
    # Number of round trips with slip that are all computed before automatic leaps may begin: on the printed slab 40 000 pieces
    # and 0.1 s.
    EXACT_TRIPS,
    # Largest shortest_event, as a share of the two-way travel time: a body with a longer one would no longer behave as a slab.
    LARGEST_SHARE,
    # Events are lumped automatically if a round trip has more pieces than this: each costs about 0.4 kB and a microsecond.
    MOST_PIECES,
    MOST_ROUND_TRIPS,  # Largest number of round trips of a slab, or periods of a block: a float64 counts up to here without gaps.
    automatic_length,  # Return the shortest event (s) of automatic lumping.
    check_creep_rtol,  # Check a tolerance of leaps over creep that `simulate` takes (None is automatic).
    check_round_trips,  # Refuse a run of more than 2^53 round trips of `round_trip` seconds, which cannot be counted exactly.
    check_shortest_event,  # Check a shortest event (s; None is automatic) that `simulate` takes.
    # Return the tolerance of leaps over creep in a run: the given or the automatic one, or 0 if there are no leaps.
    creep_tolerance,
    leaps_but_for_pull,  # Return what `leaps_over` does, whatever the pull rate, which may differ between members of a batch.
    leaps_over,  # Return what a run of a problem may leap over.
    lumps_by_itself,  # Return True if events are lumped automatically.
)
from stickslip.problem.loading import (
    HISTORIES,  # Every built-in loading history by its name in scenario files.
    # Unit of the varying quantity: m/s or rad/s for a pull rate or a velocity of the ground, m/s^2 or rad/s^2 for its
    # acceleration, and Pa, N or N m for a far stress or a normal load.
    VARYING,
    # A pull rate, far stress, normal load or motion of the ground as a function of time (s) since the start of the run.
    LoadingHistory,
    PiecewiseLinear,  # A straight line from point to point, constant before the first point and after the last.
    Segment,  # A straight part of a history from a time `start` (s) on: a value there, and its change per second.
    Steps,  # Jumps to the next value at each given time, and constant values between them: one velocity step, or several.
    Tone,  # A sinusoid amplitude (in the unit of the values) sin(frequency t + phase), of an angular frequency (rad/s) > 0.
)
from stickslip.problem.loading_history import (
    SILENT,  # The tone of a history without oscillation; its frequency of 1 rad/s has no effect, but a frequency must be positive.
)
from stickslip.problem.parameters import (
    # Name of the normal load with the initial load and the far stress in proportion: pressed harder, a contact is as near to
    # slip.
    PRESSING,
    # A number of a problem: its full name, such as "friction.alpha", its value (SI), and its unit, meaning and allowed range.
    Parameter,
    # Return the name of the parameter that is the normal load: the body's own, or `PRESSING` if that is only in proportion.
    normal_name,
    pressed_body,  # Return the body of a problem with another normal load: the weight on a string's bit is in proportion to it.
    # Return a problem with other values (SI) of its numbers, by their full names; an initial load replaces an excess, and back.
    put_many,
)
from stickslip.problem.pressing import (
    pressing_of,  # Return the growth of a normal load; one part without growth if it is constant.
)
from stickslip.problem.problem import (
    Problem,  # Everything that a run needs except its duration and its tolerance.
    check_problem,  # Raise InputError, beginning with `who`, if an object is not a problem; hint at what was probably meant.
    resistance_slope,  # Return how damping v + S mu grows with the slip rate at the start (Pa s/m or N s/m).
    written_out,  # Return a problem with its initial load and state as numbers, where they followed from steady sliding.
)
from stickslip.problem.resistance import (
    # A maximal interval of slip rates (m/s) on which g rises, with the excess over the static strength (Pa) at its two ends.
    Branch,
    Plateau,  # An interval of slip rates (m/s) on which g is constant, and the excess of g over the static strength (Pa) there.
    Resistance,  # The function g of one contact at one law slip: damping Z (Pa s/m), normal stress S (Pa), law_slip (m).
)
from stickslip.problem.run_codes import (
    BAD_PARAMETERS,  # The parameters of a member of a batch make no valid problem.
    ENOUGH_EVENTS,  # The run has reached the number of slip events that was asked for.
    FULL_HISTORY,  # The history has reached its limit of pieces, or memory is short.
    INTERRUPTED,  # The user stopped the run.
    UNDER_WAY,  # The solution comes from a checkpoint of a run that continued afterwards.
    UNSTABLE,  # Slip rates of a planar slab have grown beyond what its loads can drive.
    Stop,  # Say why the engine returned.
)
from stickslip.problem.run_options import (
    DURATION,  # Declares how long to simulate (s).
    LARGEST_HISTORY,  # Largest number of pieces that can be asked for: 0.4 TB, more than the memory of most machines.
    LARGEST_RTOL,  # Largest relative tolerance of a run.
    MAX_PIECES,  # Largest number of pieces of a history unless `max_pieces` is given: 0.8 GB.
    RUN_RTOL,  # Declares the relative tolerance of a run.
    BoundedOptions,  # The options that the engine takes: those of a run, and how many pieces its history may have.
    RunOptions,  # How long and how accurately to run a problem, when to stop, and what to call the run.
    read_option,  # Return one option in SI and in its range.
)
from stickslip.problem.run_status import (
    SHORT_OF_MEMORY,  # How the message of that status begins where memory is short.
    STATUSES,  # Status for each code: see `run_codes`.
    TOO_MANY,  # The name of the status of a run whose history is full, or whose memory is short.
    Crowd,  # A history that has reached its limit of pieces, or the share of the memory that it may take.
    # The end of a run: the name of the status, a message, and `ok`, which is true if the run got as far as it was meant to.
    Status,
)
from stickslip.problem.selection_rule import (
    PERFECT_DELAY,  # Name of the rule that keeps a branch as long as it exists: the only one where folds move with slip.
    SELECTION_RULES,  # Names of the built-in rules (`stickslip.contact.rules.selection`).
    SelectionRule,  # A function that returns a selection table for a resistance and its stable branches, slowest first.
    # The loads at which a contact leaves stick, and between which it stays on each branch: excesses over the static strength
    # (Pa).
    SelectionTable,
    names,  # Return the names of all selection rules, first the built-in ones and then the registered ones.
    registered,  # Selection rules that users have registered, by name.
)

__all__ = [
    "ALL_HISTORIES",
    "BAD_PARAMETERS",
    "BODY_KINDS",
    "DRIVERS",
    "DRIVERS_OF_WAVES",
    "DRIVER_KINDS",
    "DURATION",
    "EDGE",
    "ENOUGH_EVENTS",
    "EVENT_SHARE",
    "EXACT_TRIPS",
    "FULL_HISTORY",
    "HISTORIES",
    "HISTORIES_ONLY",
    "INITIAL_STATES",
    "INTERRUPTED",
    "LARGEST_HISTORY",
    "LARGEST_RTOL",
    "LARGEST_SHARE",
    "LOAD",
    "MAX_PIECES",
    "MAY_VARY",
    "MOST_PIECES",
    "MOST_ROUND_TRIPS",
    "PERFECT_DELAY",
    "PRESSING",
    "RUN_RTOL",
    "SELECTION_RULES",
    "SHORT_OF_MEMORY",
    "SILENT",
    "STATUSES",
    "STEADY",
    "TOO_MANY",
    "UNDER_WAY",
    "UNSTABLE",
    "VARYING",
    "Accelerogram",
    "BoundedOptions",
    "Branch",
    "Crowd",
    "Ground",
    "Inflow",
    "LoadingHistory",
    "Parameter",
    "PiecewiseLinear",
    "Plateau",
    "Problem",
    "Resistance",
    "RunOptions",
    "Segment",
    "SelectionRule",
    "SelectionTable",
    "Status",
    "Steps",
    "Stop",
    "Tone",
    "automatic_length",
    "block_for",
    "breaks_of",
    "check_creep_rtol",
    "check_event_rate",
    "check_problem",
    "check_round_trips",
    "check_shortest_event",
    "creep_tolerance",
    "default_event_rate",
    "driver_impedance",
    "driver_of",
    "far_at_first",
    "far_excess",
    "features",
    "in_given_units",
    "inflow_of",
    "leaps_but_for_pull",
    "leaps_over",
    "loading",
    "loading_rate",
    "lumps_by_itself",
    "names",
    "normal_name",
    "pace_of",
    "pressed_body",
    "pressing_of",
    "pull_of",
    "put_many",
    "read_option",
    "registered",
    "resistance_slope",
    "selection",
    "sent_back",
    "settled_rate",
    "steady_inflow",
    "tone_of",
    "tuned_period",
    "units_given",
    "units_shared",
    "wave_before",
    "written_out",
]
