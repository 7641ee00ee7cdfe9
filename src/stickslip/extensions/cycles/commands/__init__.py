"""The commands `stickslip cycle` and `stickslip lyapunov`."""
