"""From a laboratory record to the parameters of a problem, with their uncertainty."""
