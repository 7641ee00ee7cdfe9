"""The contact equation: its branches and folds, selection rules, and whether its solution is unique."""
