"""What of a batch is compiled: any edit here, as in `engine`, compiles the engine anew."""
