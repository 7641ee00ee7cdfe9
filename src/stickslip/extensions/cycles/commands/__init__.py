"""The command `stickslip cycle`."""
