"""The subcommands of `stickslip`, one in each file."""
