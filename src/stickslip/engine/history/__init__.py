"""Data that a run leaves: its history, slip events, tables, status and checkpoints."""
