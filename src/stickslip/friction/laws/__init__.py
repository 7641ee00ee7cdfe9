"""Hold the built-in friction laws, one in each file; `LAWS` in `stickslip.friction` lists them."""
