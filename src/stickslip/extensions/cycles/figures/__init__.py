"""Figures of cycles and of their branches."""
