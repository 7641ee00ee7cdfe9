"""The command line of stickslip.

What the commands of extensions take from here:

- `options`: arguments and options that several commands share, and their completion.
- `expand`: options that are declared once, as the fields of a dataclass.
- `overrides`: a scenario with numbers that were typed as options.
- `output`: tables and sentences on the terminal, checks of the files that a command will write, and their writing.
- `main`, `app`: the command, its errors in one line, and its groups.
"""
