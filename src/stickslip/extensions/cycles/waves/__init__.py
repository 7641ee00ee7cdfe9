"""Cycles of uniform bodies with waves: their start is a wave of one round trip, kept on a mesh."""
