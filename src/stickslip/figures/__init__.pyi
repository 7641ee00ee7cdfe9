from stickslip.extensions.inference.figures.measured import plot_fit
from stickslip.extensions.sweeps.figures.sweep import plot_sweep

__all__ = ["plot_fit", "plot_sweep"]
