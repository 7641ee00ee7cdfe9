"""Hold the built-in friction laws, by what friction depends on; `LAWS` in `stickslip.friction` lists them."""
