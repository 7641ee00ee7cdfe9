"""Run the command line: `python -m stickslip` does what `stickslip` does."""

import sys

if __name__ == "__main__":
    try:
        from stickslip.cli.main import command_line
    except KeyboardInterrupt:  # `command_line` deals with those that come later
        sys.exit(130)
    command_line()
