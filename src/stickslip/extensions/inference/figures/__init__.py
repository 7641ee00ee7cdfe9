"""Figures of records, of what was inferred from them, and of laws through points."""
