"""Many runs of one scenario over what varies: maps, samples, lists; kept in a store that a killed sweep takes up again."""
