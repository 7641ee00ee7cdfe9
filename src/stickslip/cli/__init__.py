"""The command line of stickslip.

- `options`, `expand`: arguments and options that several commands share, and those declared as fields of a dataclass.
- `overrides`: a scenario with numbers that were typed as options.
- `request`, `kinds`, `results`, `stored`: what `run` is asked for, how each kind of run is done and shown, and results from files.
- `output`: tables and sentences on the terminal, checks of the files that a command will write, and their writing.
"""
