from .sweeps.sweep import plot_sweep

__all__ = ["plot_sweep"]
