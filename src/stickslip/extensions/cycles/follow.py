"""Follow a cycle along one number of its problem: `ss.studies.follow`."""

from __future__ import annotations

from os import PathLike

from stickslip.extensions.cycles.branch import BranchOfCycles
from stickslip.extensions.cycles.following import Following, FullBranchError
from stickslip.extensions.cycles.limit_cycle import LimitCycle
from stickslip.extensions.cycles.reaching import range_of
from stickslip.extensions.cycles.resuming import check_can_be_kept, points_to_go_on
from stickslip.foundation.arguments import for_users
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.run import TextProgress, telling

STEPS = 40
"""About how many steps cross the range (1)."""


@for_users
def follow(
    cycle: LimitCycle,
    along: str = "pull_rate",
    *,
    to: float | str | WithUnit,
    steps: int = STEPS,
    double: bool = False,
    resume: BranchOfCycles | str | PathLike[str] | None = None,
    progress: TextProgress | bool | None = None,
) -> BranchOfCycles:
    """Follow a cycle along one number of its problem, through folds, with the edges where it changes.

    Parameters
    ----------
    cycle : LimitCycle
        The cycle where the branch begins, from `stickslip.studies.cycle`.
    along : str
        The parameter that is varied, as in a sweep: "pull_rate", "body.stiffness", "friction.parameters.v1" ...
    to : float or str
        Its value (SI, or a text with a unit) at the other end. Behind a fold the branch may come back to where it began.
    steps : int
        About how many steps cross the range.
    double : bool
        True follows the cycles of twice the period, too, that branch off where the period doubles, up to eight times the period.
    resume : BranchOfCycles, str or Path, optional
        A branch of the same cycle that Ctrl-C has ended, or its table (.csv): it goes on where it ends, to another `to`, too.
    progress : bool or callable, optional
        True shows the progress in one line; a function is called with a line of text after each cycle.

    Returns
    -------
    BranchOfCycles
        The cycles in their order along the branch, and its edges. Ctrl-C ends it early: it is then `interrupted`, and can go on.
        So does one that has 200 cycles (`is_full`).

    Raises
    ------
    InputError
        If the parameter is unknown or is no number, if there is no other value to go to, or if `resume` is another branch.
    KeyboardInterrupt
        If the user presses Ctrl-C before the first cycle.

    Notes
    -----
    Start and parameter are changed together along the branch (pseudo-arclength), so that it can turn back. Edges: a fold of cycles
    (multiplier +1), period doubling (-1), Neimark-Sacker (a pair on the unit circle), loss of stick (the arrest is grazed), first
    stick, grazing of a hard stop, and steady sliding or the end of hunting, where a cycle vanishes. Of the branches that begin at
    an edge those are followed that meet where stick is lost, with and without rest, or where a stop is grazed, with and without
    impact; and cycles of twice the period if they are wished.

    Examples
    --------
    >>> import stickslip as ss
    >>> law = ss.friction.FromExpression("0.3 + 0.2*exp(-v/v1)", {"v1": "50 mm/s"})
    >>> block = ss.SpringBlock(mass=1.0, stiffness=1e3, normal_force=10.0, damping=2.0)
    >>> start = ss.studies.cycle(ss.Problem(block, law, pull_rate=0.28, initial_load=0.0))
    >>> branch = ss.studies.follow(start, "pull_rate", to=0.35, steps=4)
    >>> print([f"{edge.name} at {edge.value:.6f} m/s" for edge in branch.edges])
    ['loss of stick at 0.302222 m/s']
    """
    if not isinstance(cycle, LimitCycle):
        raise InputError(f"follow: needs a cycle, as ss.studies.cycle finds it, got {type(cycle).__name__}")
    parameter, begin, end = range_of(cycle, along, to)
    if steps < 1:
        raise InputError(f"follow: steps must be 1 or more, got {steps}")
    check_can_be_kept(cycle, double=double, resume=resume is not None)
    with telling(progress, "follow") as tell:
        search, interrupted, full = Following(cycle, parameter, (begin, end), steps, tell, double), False, False
        try:
            search.run([] if resume is None else points_to_go_on(resume, cycle, parameter, (begin, end)))
        except KeyboardInterrupt:
            if not search.points:
                raise
            interrupted = True
        except FullBranchError:
            full = True
    return BranchOfCycles(cycle, parameter, tuple(search.points), tuple(search.edges), end, interrupted, full)
