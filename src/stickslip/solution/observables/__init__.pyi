# What others take from solution.observables. Each name is imported when it is first used; all else is the room's own.

from stickslip.solution.observables.driver_of_waves import (
    # Return the times (s since the epoch) when the ends of recorded pieces are at the driver, in the run, and the run's ends.
    fronts_at_driver,
)
from stickslip.solution.observables.energetics import (
    # Return two tractions against the slip of each event (Pa, block: N): before it, and the smallest of its pulses.
    extreme_tractions,
)
from stickslip.solution.observables.energy.balance import (
    energies,  # Return the energies at positions in a history.
    heat,  # Return the friction heat up to each position, from the law.
    taken,  # Return what a dashpot at the contact has taken up to each position.
    trapped_note,  # Return one line on the waves that travel in the body at the end of a run.
)
from stickslip.solution.observables.energy.ground import (
    shaken,  # Return the work of moving ground on a slab up to each position, J/m^2; it is 0 where the ground is at rest.
    speed,  # Return the absolute velocity of the contact (m/s): its slip rate, and the velocity of the ground.
)
from stickslip.solution.observables.energy.pulses import (
    PULSE_COLUMNS,  # Columns of `Solution.pulses`: unit, as `names.si_unit` understands it, and meaning.
    Pulses,  # Pulses in order of time: the event of each; where it begins, is weakest and ends; and its largest slip rate (m/s).
)
from stickslip.solution.observables.event_stream import (
    EventStream,  # Follow a history and report its slip events.
    HistoryPlace,  # A place in the history: a piece, and xi in it.
    Look,  # New events in a stream; they count as reported after `tell`.
)
from stickslip.solution.observables.event_table import (
    EVENT_COLUMNS,  # Columns of the catalogue.
    NEEDED,  # Columns without which a table is no catalogue.
    # Return statistics of the events of a catalogue, such as `Solution.events`, one row per quantity, in the unit of the
    # quantity.
    catalogue_statistics,
    event_columns,  # Return the columns of EVENT_COLUMNS, and of ENERGY_COLUMNS with `energies`, with one row per event.
    shown_columns,  # Return the names of the columns that summaries show, in their order.
    # Return the values of a column that count in statistics: finite, and not of an event that the end of the run cuts off.
    that_count,
    with_units,  # Return a table of slip events whose headings name the units of columns that are known, such as "slip (m)".
)
from stickslip.solution.observables.field import (
    # The wave that left the contact between two times (s since the epoch): w = 2 Z v - beta, plus the reference strength.
    WaveInterval,
    # Raise InputError if waves that left the contact between two times (s since the epoch) left it in a leap over creep.
    check_known,
    extent_of,  # Return the places inside the body of a problem.
    slab_of,  # Return the slab or the string of a problem.
)
from stickslip.solution.observables.layers import (
    LayerWaves,  # The waves in a body of layers at any time of a history.
)
from stickslip.solution.observables.predictability import (
    LOST,  # A disturbance of this share of the waves that slip sends out changes an event into another one: it ends the horizon.
    Predictability,  # The result of `predictability`, at the start times (s) of pieces of the history, or of slip events.
    attributes_of,  # Return what files store of it: the line of text, the horizon (s) and the exponent (1/s).
    in_short,  # Return what is proven of a run, trapped in its waves and predictable, each in a few words, as one line.
    is_followed,  # Return True if the growth of a disturbance is known for this problem.
    # Return the predictability from the column "amplification" of a catalogue and from the tolerance `rtol` of its run.
    predictability_of_events,
)
from stickslip.solution.observables.proof import (
    Proven,  # Proven bounds for some pieces of a history: the largest one (Pa or N), and numbers of steps.
    proven,  # Return the proven bounds for a history.
)
from stickslip.solution.observables.quadrature import (
    FULL,  # Number of nodes of the Gauss-Legendre rule on a piece.
)
from stickslip.solution.observables.rule_influence import (
    RuleInfluence,  # Decisions of the selection rule in a run, in a `regime` of the contact.
)
from stickslip.solution.observables.waves import (
    OfWave,  # A density as a function of a wave (Pa, plus or minus the reference) and of a time (s).
    # Radiation through a driver of finite impedance Zd: `work` is done by the waves that continue beyond it, Zd (v - V)^2.
    Radiation,
    Sampled,  # A wave at the places of a quadrature.
    Waves,  # Integrals over the waves in a slab; energies are in J/m^2.
)

__all__ = [
    "EVENT_COLUMNS",
    "FULL",
    "LOST",
    "NEEDED",
    "PULSE_COLUMNS",
    "EventStream",
    "HistoryPlace",
    "LayerWaves",
    "Look",
    "OfWave",
    "Predictability",
    "Proven",
    "Pulses",
    "Radiation",
    "RuleInfluence",
    "Sampled",
    "WaveInterval",
    "Waves",
    "attributes_of",
    "catalogue_statistics",
    "check_known",
    "energies",
    "event_columns",
    "extent_of",
    "extreme_tractions",
    "fronts_at_driver",
    "heat",
    "in_short",
    "is_followed",
    "predictability_of_events",
    "proven",
    "shaken",
    "shown_columns",
    "slab_of",
    "speed",
    "taken",
    "that_count",
    "trapped_note",
    "with_units",
]
