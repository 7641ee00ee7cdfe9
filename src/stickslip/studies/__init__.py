"""Studies that run a problem several times and compare the runs."""
