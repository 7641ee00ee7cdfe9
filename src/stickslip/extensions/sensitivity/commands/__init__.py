"""The command `stickslip sensitivity`."""
