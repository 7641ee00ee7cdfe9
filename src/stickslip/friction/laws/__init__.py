"""Hold the built-in friction laws, one in each file; `stickslip.friction.registry` lists them."""
