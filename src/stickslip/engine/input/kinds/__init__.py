"""What the engine is told of each kind of body: a module for each."""
