"""What each kind of body answers about steady sliding."""
