"""Memory with named places and addresses, alone and in the lanes of registers."""
