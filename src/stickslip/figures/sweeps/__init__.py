"""Figures of sweeps: curves, maps, maps side by side, points, and cells of refined maps."""
