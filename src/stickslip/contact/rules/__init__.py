"""The built-in selection rules, and their jumps as the load slowly rises and falls."""
