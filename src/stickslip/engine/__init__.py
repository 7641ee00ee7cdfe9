"""The compiled engine, which works on numbers and addresses and never sees a `Problem`."""
