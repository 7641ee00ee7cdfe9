"""Running a problem: at once, taken up again after a stop, or told event by event."""
