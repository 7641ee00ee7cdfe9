# What others take from engine.lanes. Each name is imported when it is first used; all else is the room's own.

from stickslip.engine.lanes.reduction import (
    OF_EVENTS,  # Columns that need slip events.
    REDUCED_COLUMNS,  # Names of these numbers, in the order of their columns in a table of results.
    Reduced,  # Hold the numbers that are kept of each run, in SI units; NaN where a run has none.
    # Write the numbers that describe a run of which only the last pieces are known, but keep what all pieces determine.
    fold_end,
)
from stickslip.engine.lanes.runs import (
    Group,  # Hold members that differ in numbers only, and where their results go.
    engine_address,  # Return the address of the machine code of `loop.run_until`; compile it if no single run has done so.
    run_group,  # Run members, each in a lane of the workspace, and write their stop codes and numbers into the group.
)
from stickslip.engine.lanes.setups import (
    Alike,  # The properties that the members of a group share, whatever their numbers.
    alike,  # Return what the members of one group (`vectorised_problem.groups`) share.
    set_up,  # Return the input of the engine for the members of one group (`vectorised_problem.groups`).
)
from stickslip.engine.lanes.vectorised_problem import (
    QUANTITIES,  # Names of the quantities that a batch can compute from a run.
    Values,  # Numbers in SI, one for each member, by key such as "friction.alpha".
    # Return True for the members whose parameters are valid: bodies, laws, problems and scenarios check the same for one.
    are_fine,
    # Yield the groups of members that differ in numbers only: the kind of a group, and the indices and values of its members.
    groups,
    member,  # Return the scenario of one member.
    why_not,  # Return in one line why a batch cannot run a scenario with these parameters and quantities; "" if it can.
)
from stickslip.engine.lanes.workspace import (
    LARGEST_CAPACITY,  # Largest room of a lane in pieces of history; a member that needs more is run by itself.
    LaneStage,  # Say what a lane is doing.
    new_workspace,  # Return the workspace of one thread.
    # Return the addresses of the tables that the first member uses in each lane, and their strides from member to member (bytes).
    table_of,
)

__all__ = [
    "LARGEST_CAPACITY",
    "OF_EVENTS",
    "QUANTITIES",
    "REDUCED_COLUMNS",
    "Alike",
    "Group",
    "LaneStage",
    "Reduced",
    "Values",
    "alike",
    "are_fine",
    "engine_address",
    "fold_end",
    "groups",
    "member",
    "new_workspace",
    "run_group",
    "set_up",
    "table_of",
    "why_not",
]
