"""The compiler and its cache, and the code that is written for each friction formula."""
