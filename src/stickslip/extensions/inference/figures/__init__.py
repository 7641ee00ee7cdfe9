"""Figures of records, of fits to them, and of laws through points."""
