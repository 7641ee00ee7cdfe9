"""The free numbers of a problem, the runs that follow a record, and the search for the best ones."""
