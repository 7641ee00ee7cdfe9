"""Hold the built-in friction laws, grouped by the variables of friction; `LAWS` in `stickslip.friction` lists them."""
