"""What is calculated from the history of a run."""
