"""Figures of sensitivities."""
