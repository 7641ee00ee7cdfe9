"""Branches of the contact equation, and levels of selection rules, that move with slip."""
