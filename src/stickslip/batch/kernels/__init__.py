"""What of a batch is compiled: any edit here, as in `evolution`, compiles the engine anew."""
