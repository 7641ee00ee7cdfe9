"""Friction laws of what users bring: expressions, functions, measured points."""
