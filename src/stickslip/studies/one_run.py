"""Studies that need a single problem or run: critical values, steady sliding, predictability and the statistics of a catalogue."""

from pathlib import Path

from stickslip.contact.critical import critical_value
from stickslip.contact.sliding import SteadySlidings
from stickslip.contact.steady import steady_slidings
from stickslip.foundation.arguments import for_users
from stickslip.observables.event_table import catalogue_statistics
from stickslip.observables.predictability import predictability
from stickslip.problem.problem import Problem
from stickslip.scenarios.scenario import Scenario
from stickslip.scenarios.source import read_source

__all__ = ["catalogue_statistics", "critical_value", "predictability", "steady"]


@for_users
def steady(problem: Problem | Scenario | str | Path) -> SteadySlidings:
    """Find how a contact slides steadily at its pull rate, whether that is stable, and at which rates stability changes.

    Parameters
    ----------
    problem : Problem, Scenario, str or Path
        The problem, its scenario, the name of a bundled scenario, or a scenario file. If its loading varies, the answer is about
        the value at the start.

    Returns
    -------
    SteadySlidings
        `slidings` (slip rate, traction, stability, growth rate and period of a small disturbance), `changes` (critical slip and
        pull rates, with proof where the law has no state), and what is said of them by `print`.

    Raises
    ------
    InputError
        If the scenario has a contact of many nodes, or there is no such scenario.

    Notes
    -----
    From rest a contact may stick at pull rates at which steady sliding is stable: `find` tells up to which.

    Examples
    --------
    >>> import stickslip as ss
    >>> law = ss.friction.FromExpression("0.3 + 0.2*exp(-v/v1)", {"v1": "50 mm/s"})
    >>> body = ss.SpringBlock(mass=1.0, stiffness=1e3, normal_force=10.0, damping=5.0)
    >>> found = ss.studies.steady(ss.Problem(body, law, pull_rate=0.05, initial_load=0.0))
    >>> found.slidings[0].stable, round(found.changes[0].pull_rate, 6)
    (False, 0.103972)
    """
    found = read_source("steady", problem)
    return steady_slidings(found if isinstance(found, Problem) else found.problem)
