"""Studies: many runs of one problem, and what they say together."""
