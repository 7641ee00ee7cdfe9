"""The command `stickslip`: errors become one line and an exit code, and an end from outside is quiet.

Only what every Python has at hand is imported here: the rest takes a tenth of a second, in which Ctrl-C would show a traceback.
"""

from __future__ import annotations

import atexit
import gc
import os
import signal
import sys
import traceback
import warnings
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, redirect_stderr, redirect_stdout
from contextvars import copy_context
from typing import Any

FAULT = 70
"""Exit code after an error that is no user's mistake, as in sysexits.h."""
REPORT = "please report it with the lines above, the scenario and what `stickslip doctor` says"
INTERRUPTED = 130
"""Exit code after Ctrl-C, as in shells: 128 and the number of the signal."""
COLLECT_AFTER = 400_000
"""Number of new objects after which Python looks for cycles of unused ones in a process of the command line.

With Python's 700 these searches take a fifth of a second while modules are imported, and imports leave nothing to be found: 140 000
objects in a run, 310 000 in a sweep, through which a single search takes 30 ms.
"""


def command_line() -> None:
    """Run the command line as all that its process does: `main`, with fewer searches for unused objects and a quick end."""
    gc.set_threshold(COLLECT_AFTER)
    code: list[int] = []
    atexit.register(_end_at_once, code)
    try:
        main()
    except SystemExit as ended:
        if isinstance(ended.code, int):
            code.append(ended.code)
        raise


def _end_at_once(code: list[int]) -> None:
    """End the process with the code, if it has one, instead of taking apart objects one by one, which takes a tenth of a second.

    What is registered first is called last: threads have ended by now, and libraries that are imported later have tidied up.
    """
    for one in code:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(one)


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and exit with a code.

    It is 0 (done), 1 (the run failed), 2 (the input cannot be used), 70 (a fault of the program) or 130 (interrupted).
    """
    with ExitStack() as streams:
        streams.enter_context(redirect_stdout(_Heard(sys.stdout)))
        streams.enter_context(redirect_stderr(_Heard(sys.stderr)))
        streams.enter_context(warnings.catch_warnings())  # extensions that are left out are told while commands are imported
        warnings.showwarning = _show_warning
        with _quiet_start():
            from stickslip.foundation.errors import InputError, InputWarning

            warnings.simplefilter("default", InputWarning)
            try:
                import stickslip.cli.app  # noqa: F401  # takes long: all that follows needs it
            except InputError as error:  # typer does not suit
                sys.exit(_fail(str(error)))
        code = copy_context().run(_code, arguments)  # what a command sets, such as units to show, ends with it
        sys.stdout.flush()
    sys.exit(code)


class _Heard:
    """A text stream that falls silent when nobody reads it any more, as after `| head`; the work goes on to its end.

    A character that the stream has no code for is written as an escape, as Python does on standard error.
    """

    def __init__(self, stream: Any) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        """Write a text."""
        try:
            return int(self._stream.write(text))
        except UnicodeEncodeError as error:
            return int(self._stream.write(text.encode(error.encoding, "backslashreplace").decode(error.encoding)))
        except BrokenPipeError:
            self._fall_silent()
            return len(text)

    def flush(self) -> None:
        """Write what has been kept back."""
        try:
            self._stream.flush()
        except BrokenPipeError:
            self._fall_silent()

    def _fall_silent(self) -> None:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, self._stream.fileno())
        os.close(nowhere)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


@contextmanager
def _quiet_start() -> Iterator[None]:
    """Let Ctrl-C end the process at once while modules are imported: some of them would turn it into an error of their own."""
    try:
        ours = signal.getsignal(signal.SIGINT) is signal.default_int_handler
        if ours:
            signal.signal(signal.SIGINT, lambda *_: os._exit(INTERRUPTED))
    except ValueError:  # not in the main thread, which alone receives signals
        ours = False
    try:
        yield
    finally:
        if ours:
            signal.signal(signal.SIGINT, signal.default_int_handler)


def _code(arguments: Sequence[str] | None) -> int:
    """Run the command line, and return the exit code."""
    from typer import Abort

    from stickslip.cli.app import TyperException, app
    from stickslip.cli.mistyped import explain
    from stickslip.foundation.errors import InputError

    try:
        code = app(arguments, prog_name="stickslip", standalone_mode=False)
    except InputError as error:
        return _fail(str(error))
    except TyperException as error:
        return _fail(explain(error))
    except OSError as error:
        return _fail(f"{error.filename}: {error.strerror}" if error.filename and error.strerror else str(error))
    except (KeyboardInterrupt, Abort):
        code = INTERRUPTED
    except Exception:  # whatever else is raised is no user's mistake
        sys.stderr.write(traceback.format_exc())
        return _fail(f"this is a fault of the program; {REPORT}", FAULT)
    if code == INTERRUPTED:
        return _fail("interrupted", code)
    return code if isinstance(code, int) else 0


def _show_warning(message: Warning | str, category: type[Warning], filename: str, lineno: int, *_: Any, **__: Any) -> None:
    """Show what to know about the input as one line on standard error, and other warnings as Python does."""
    from stickslip.foundation.errors import InputWarning

    shown = f"stickslip: note: {message}\n" if issubclass(category, InputWarning) else None
    sys.stderr.write(shown or warnings.formatwarning(message, category, filename, lineno))


def _fail(message: str, code: int = 2) -> int:
    from stickslip.foundation.errors import printable

    sys.stderr.write(f"stickslip: {printable(' '.join(message.split()))}\n")
    return code
