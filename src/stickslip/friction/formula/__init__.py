"""Formulas of friction laws as expression trees: reading, units, differences, bounds, text."""
