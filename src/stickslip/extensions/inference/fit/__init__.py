"""The free numbers of a problem, runs under the loading of a record, and the search for the best fit."""
