"""Steady sliding of one problem, with runs from rest where a critical pull rate asks for them."""

from dataclasses import replace
from pathlib import Path

from stickslip.contact import SteadySlidings, proven_slidings
from stickslip.foundation.arguments import for_users
from stickslip.problem import Problem
from stickslip.problem.scenarios import Scenario, read_problem
from stickslip.run.study import TextProgress, telling


@for_users
def steady(
    problem: Problem | Scenario | str | Path, *, from_rest: bool = True, progress: TextProgress | bool | None = None
) -> SteadySlidings:
    """Find how a contact slides steadily at its pull rate, whether that is stable, and at which rates stability changes.

    Parameters
    ----------
    problem : Problem, Scenario, str or Path
        The problem, its scenario, the name of a bundled scenario, or a scenario file. If its loading varies, the answer is about
        the value at the start.
    from_rest : bool
        Whether to find, by a dozen exact runs, up to which pull rate a contact that starts from rest sticks although steady
        sliding is stable. These runs are made only where a critical pull rate asks for them, and no run has more than 100 000
        pieces.
    progress : bool or callable, optional
        True shows the progress of these runs in one line; a function is called with a line of text after each run.

    Returns
    -------
    SteadySlidings
        `slidings` (slip rate, traction, stability, growth rate and period of a small disturbance), `changes` (critical slip and
        pull rates, with proof where the law has no state), `from_rest` (the pull rates up to which it sticks and from which it
        slides), and what is said of them by `print`.

    Raises
    ------
    InputError
        If the scenario has a contact of many nodes, or there is no such scenario.

    KeyboardInterrupt
        If the user presses Ctrl-C.

    Examples
    --------
    >>> import stickslip as ss
    >>> law = ss.friction.FromExpression("0.3 + 0.2*exp(-v/v1)", {"v1": "50 mm/s"})
    >>> body = ss.SpringBlock(mass=1.0, stiffness=1e3, normal_force=10.0, damping=5.0)
    >>> found = ss.studies.steady(ss.Problem(body, law, pull_rate=0.05, initial_load=0.0))
    >>> found.slidings[0].stable, round(found.changes[0].pull_rate, 6), round(found.from_rest.sticks_at, 2)
    (False, 0.103972, 0.15)
    """
    one = read_problem("steady", problem)
    found = proven_slidings(one)
    if not from_rest or found.regained is None:
        return found
    from stickslip.run.find import from_rest as runs_from_rest  # here, because most contacts need no runs

    with telling(progress, "steady") as tell:
        return replace(found, from_rest=runs_from_rest(one, found, tell))
