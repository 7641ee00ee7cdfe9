from .contact.measured import plot_fit
from .sweeps.sweep import plot_sweep

__all__ = ["plot_fit", "plot_sweep"]
