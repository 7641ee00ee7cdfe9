"""Problems: a body, a friction law, how they are loaded, and the rule that selects a slip rate."""
