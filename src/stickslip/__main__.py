"""Run the command line: `python -m stickslip` does what `stickslip` does."""

from stickslip.cli.main import main

if __name__ == "__main__":
    main()
