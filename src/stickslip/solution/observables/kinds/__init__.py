"""What each kind of body makes of a finished run (`solution.observables.asked`)."""
