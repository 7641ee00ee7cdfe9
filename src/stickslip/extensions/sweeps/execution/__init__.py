"""The execution of a sweep: its plan, its chunks, and the processes that run them."""
