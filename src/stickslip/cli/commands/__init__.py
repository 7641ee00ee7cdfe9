"""The commands of `stickslip`, one a file."""
