"""How a sweep is run: a plan divides it into chunks, and threads or processes run them."""
