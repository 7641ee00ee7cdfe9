"""Runs that outlast a sitting: taken up again after a stop, and told event by event where their history would fill the memory."""
