"""Folds with proof, by interval arithmetic."""
