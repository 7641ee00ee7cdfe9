"""Folds of the contact equation: where they are, and steps up to and away from them, also where they move with slip."""
