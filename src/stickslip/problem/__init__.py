"""Define problems: a body, a friction law, the loading, the initial state, and the rule that selects a slip rate."""

from stickslip.problem import selection_rule as selection
from stickslip.problem.problem import Problem

__all__ = ["Problem", "selection"]
