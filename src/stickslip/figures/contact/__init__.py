"""Figures of the contact: laws, resistance, regimes."""
