"""Figures of sweeps: curves, maps, maps side by side, and points."""
