"""What each kind of body answers to the search for cycles, a module for each."""
