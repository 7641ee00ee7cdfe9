"""The command line of stickslip."""
