"""What each kind of driver does to the waves behind a body, and to their energy (`solution.observables.driver_of_waves`)."""
