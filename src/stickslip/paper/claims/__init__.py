"""The claims of the paper, by number, and the functions that measure them."""

from __future__ import annotations

from collections.abc import Callable

from stickslip.paper.cases import Runs
from stickslip.paper.claims import inertia, rate_law, rules, slip_law
from stickslip.paper.claims.verdict import STATEMENTS, Measured, Outcome, Verdict

CLAIMS: dict[int, Callable[[Runs], Verdict]] = {
    1: slip_law.block_slips_once,
    2: slip_law.slab_pulses,
    3: slip_law.echo_arrests,
    4: slip_law.what_sets_the_pulses,
    5: rate_law.block_is_continuous,
    6: rate_law.slab_jumps,
    7: rules.critical_value,
    8: rules.three_solutions,
    9: rules.one_solution,
    10: slip_law.well_posed,
    11: rules.shocks_for_every_rule,
    12: rules.not_an_energy_criterion,
    13: rate_law.irregular_regime,
    14: inertia.concentrated_mass,
    15: inertia.block_stays_put,
    16: slip_law.close_to_instability,
    17: rules.hysteresis,
    18: rate_law.just_above_critical,
    19: rate_law.like_coulomb,
    20: rate_law.load_before_the_echo,
}
"""The function that measures each claim, by the number of the claim."""

__all__ = ["CLAIMS", "STATEMENTS", "Measured", "Outcome", "Runs", "Verdict"]
