"""Run a problem: with its whole history, resumed after a stop, or as a table of slip events alone."""
