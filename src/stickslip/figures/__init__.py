"""Figures; each module makes its data, draws it, or both."""
