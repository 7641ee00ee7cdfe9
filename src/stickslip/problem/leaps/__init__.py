"""What a run may leap over, and which short slip events it may lump: a module for each kind of body."""
