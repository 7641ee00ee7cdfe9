"""How well a record determines the numbers found: directions, intervals, samples of the posterior distribution."""
