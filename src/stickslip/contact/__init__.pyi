# What others take from contact. Each name is imported when it is first used; all else is the room's own.

from stickslip.contact.branches import (
    # Return the stable branches of a resistance, slowest first, from the proof of its folds (worked out here by default).
    branches_of,
    rate_on,  # Return the slip rate (m/s) on a branch whose resistance exceeds the static strength by `excess` (Pa), to rounding.
    # Return the resistance of a slab's contact at a law slip (m) and under a normal load (Pa); default: the initial ones.
    resistance,
)
from stickslip.contact.critical import (
    critical_normal_stress,  # Return the critical normal stress (Pa), Z / max(-dmu/dv), or None: above it the contact is irregular.
    # Find the critical values of one parameter to rounding: there the contact equation changes between one solution and several.
    critical_value,
    margin,  # Return the smallest g'/Z over all slip rates at a law slip (m; default: the initial one).
)
from stickslip.contact.folds import (
    Fold,  # A slip rate (m/s) at which g changes between rising and falling, and the load (Pa) there.
)
from stickslip.contact.layer_response import (
    # Return the growth rate (1/s) of a perturbation of layers that rest under friction falling with slip, by -S mu'(u) (Pa/m).
    growth_on_layers,
)
from stickslip.contact.regime import (
    # Return why a problem whose folds move with its normal load cannot be run under its selection rule; empty if it can.
    folds_not_followed,
    # Return the `regime` of `uniqueness_of` without the jumps and loop of the rule: a sweep asks for it in each of its runs.
    regime_of,
    # Return the regime of a contact without mass, at the first slip of its law, under the largest normal load that it ever bears.
    regime_when_pressed,
)
from stickslip.contact.regime_map import (
    RegimeMap,  # The result of `regime_map` over two axes.
    put_both,  # Return the problem with other values of two parameters, or None if it refuses them.
    # Return the intervals of law slip with one regime each, from the initial slip over the length `slip_reach`.
    regimes_along_slip,
    two_parameters,  # Return the parameters of two axes.
)
from stickslip.contact.roots import (
    sign_change,  # Return the place, to rounding, where a function changes between negative and not negative.
)
from stickslip.contact.rules.loop import (
    first_rate,  # Return the slip rate (m/s) to which a massless contact jumps forwards at t = 0+.
    resolved,  # Return a slip rate (m/s), or 0, rest, if Z v is lost in the rounding of the load (Pa; block: N).
)
from stickslip.contact.rules.selection import (
    OF_LEVELS,  # Names of the rules that need nothing but `levels`: a batch supports them.
    Branches,  # The stable branches of a contact, slowest first.
    # Return the largest load of stick, and the smallest and largest load of each branch under a rule, for any number of contacts.
    levels,
    rule_of,  # Return the selection rule of a problem.
    # Return the branches of the problem's contact at a law slip (m) and a normal load (Pa), and the table of its rule.
    selection_table,
    table_of,  # Return the table of the problem's rule.
)
from stickslip.contact.sliding import (
    FROM_REST_WITHIN,  # The highest pull rate that lets a contact stick from rest is found to this relative width.
    FromRest,  # Outcome of exact runs from rest at pull rates with stable steady sliding; rates (m/s) without their sign.
    Sliding,  # One steady sliding motion: slip rate and traction with their signs, and what a small disturbance does.
    SteadySlidings,  # All steady sliding motions of a problem at its pull rate, and the rates where their stability changes.
    driven_at,  # Return the words for the slip rate (in `unit`) of steady sliding: that of the driver, if it does not give way.
    slides_on,  # Return a sentence without its subject, a contact that slides steadily and stays at this rate.
)
from stickslip.contact.slopes import (
    FASTEST_BOUNDED,  # Bounds of g' cover slip rates up to this (m/s); no contact is that fast.
    # The pieces of the laws of many contacts, with one entry for each: those of a contact follow each other, slowest first.
    Pieces,
)
from stickslip.contact.steady import (
    proven_slidings,  # Find what `steady_slidings` does, with proof for laws with a state where there is one (0.3 s and more).
    # Return the fastest slip rate (m/s, without its sign) of steady sliding at another pull rate (m/s); None if there is none.
    slip_rate_at,
    # Find the steady sliding of a contact under the loading of a problem (at the start if it varies), and its stability.
    steady_slidings,
    # Return the size of the traction (Pa or N) of steady sliding at slip rates (m/s) in the direction of the drive.
    steady_traction,
)
from stickslip.contact.turns import (
    find_turns,  # Find all turns of g, with at most about `budget` evaluations for each contact.
    folds_of,  # Return the slip rates of the ends of branches, by contact and ascending, and the piece of each.
)
from stickslip.contact.uniqueness import (
    Uniqueness,  # The result of `stickslip.uniqueness`; `print` shows it in sentences.
    uniqueness_of,  # Determine the uniqueness of the slip rate of a problem: see `stickslip.uniqueness`.
)

__all__ = [
    "FASTEST_BOUNDED",
    "FROM_REST_WITHIN",
    "OF_LEVELS",
    "Branches",
    "Fold",
    "FromRest",
    "Pieces",
    "RegimeMap",
    "Sliding",
    "SteadySlidings",
    "Uniqueness",
    "branches_of",
    "critical_normal_stress",
    "critical_value",
    "driven_at",
    "find_turns",
    "first_rate",
    "folds_not_followed",
    "folds_of",
    "growth_on_layers",
    "levels",
    "margin",
    "proven_slidings",
    "put_both",
    "rate_on",
    "regime_of",
    "regime_when_pressed",
    "regimes_along_slip",
    "resistance",
    "resolved",
    "rule_of",
    "selection_table",
    "sign_change",
    "slides_on",
    "slip_rate_at",
    "steady_slidings",
    "steady_traction",
    "table_of",
    "two_parameters",
    "uniqueness_of",
]
