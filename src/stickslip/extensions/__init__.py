"""What stands beside the core: each extension in a folder of its own, with its solver, commands, figures and files.

The core knows none of them by name: `stickslip.extension` says what an extension may add, and how it is found.
"""
