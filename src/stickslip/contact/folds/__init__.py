"""Proven folds and bounds of the slope of the resistance, by interval arithmetic."""
