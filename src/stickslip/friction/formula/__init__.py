"""Represent formulas of friction laws as expression trees: parsing, units, differences, bounds and text."""
