"""Provide the compiled functions of a batch. Like an edit in `engine`, any edit here makes the engine compile anew."""
