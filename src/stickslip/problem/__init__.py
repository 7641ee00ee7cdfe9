"""Define problems: a body, a friction law, the loading, the initial state, and the rule that selects a slip rate."""
