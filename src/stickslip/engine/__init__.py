"""The compiled engine: it knows numbers and addresses, and never a `Problem`."""
