"""Results of a run: values at any time, tables of events, and windows around events."""
