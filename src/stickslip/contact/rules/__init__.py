"""The built-in selection rules, and what they do as the load slowly passes."""
