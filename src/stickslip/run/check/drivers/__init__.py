"""What `check` says of each kind of driver: a module for each, whose `ANSWERS` answer `CheckOfDriver`."""
