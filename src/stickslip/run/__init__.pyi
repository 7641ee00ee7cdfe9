# What others take from run. Each name is imported when it is first used; all else is the room's own.

from stickslip.run.catalogue import (
    CAPACITY,  # Initial room of a catalogue in pieces of history, about 7 MB; it grows only if the pieces to keep fill half of it.
    Catalogue,  # The result of a run without a history: its rows, the number of events that are over, and the reason for its end.
    catalogue_of,  # Run from the start; with a path, an earlier table and checkpoint of the same names are deleted first.
    check_energy,  # Refuse energies for a run that leaps over creep.
    checkpoint_of,  # Return the path of the checkpoint beside a catalogue.
)
from stickslip.run.exact_run import (
    ExactRun,  # A session with its slip events, an implementation of `run.solver.Solver`.
)
from stickslip.run.find import (
    Edge,  # The result of `find`: the last bracket, between whose ends what was looked for changes.
)
from stickslip.run.kinds import (
    ALL_TAKE,  # Options that each solver takes.
    FILES_OF_CORE,  # Suffixes of results that the core reads itself.
    Reader,  # Reads what an extension leaves in folders, or in files of its own.
    SolverKind,  # One of the solvers of `simulate`, and the options that it takes.
    no_results,  # Return the error for a folder that no reader reads; if its metadata cannot be read, with the reason.
    reader_of,  # Return the reader of the extension whose results a path holds; None if it holds none that an extension reads.
    # Return the solver of a scenario or an object of an extension; None for what the exact solver of the core is for.
    special_solver_of,
)
from stickslip.run.one_run import (
    steady,  # Find how a contact slides steadily at its pull rate, whether that is stable, and at which rates stability changes.
)
from stickslip.run.options import (
    CallOptions,  # The options of a run, and what only the call has: see `stickslip.simulate`.
)
from stickslip.run.progress import (
    Pace,  # Measure how fast a run goes since its first report: wall-clock time (s), simulated time (s), and share of the run done.
    how_far,  # Return in words how far a run has come: both in s.
    how_fast,  # Return in words the simulated time per wall-clock time, and the wall-clock time left (s), as far as they are known.
    progress_line,  # Show progress on a terminal or in a notebook until the end of the context, which removes the line.
    # Provide the function that receives the progress of `what`: the user's function, or a display if `progress` is True.
    reporting,
)
from stickslip.run.resume import (
    PausedCatalogue,  # The state of a catalogue's run, as read from its checkpoint.
    resume_run,  # Continue a run that was read from a file.
)
from stickslip.run.run_loop import (
    Interrupts,  # Note the first Ctrl-C instead of raising KeyboardInterrupt, so that a run ends between two calls of the engine.
    WholeHistory,  # The sink of a run that keeps its whole history and becomes a solution.
    run_to_end,  # Run a solver to the end and return the result of the sink.
)
from stickslip.run.source import (
    RunSource,  # A run to compare or to export: its name, and a function that runs or reads it, with a callback for its progress.
    # Return the run described by a bundled scenario's name, a scenario file, a solution file (.nc), a scenario or a solution.
    run_source,
)
from stickslip.run.study import (
    Study,  # The result of a study: a table, a text and a figure.
    StudyWithDataset,  # The result of a study whose figure is drawn from a dataset, which `to_dataset` gives.
    TextProgress,  # A function that is called with a line of text on the progress of a study.
    # Provide the function that receives the progress of a study, as `reporting` does; it does nothing if no progress is wanted.
    telling,
    uninterrupted,  # Return a solution that has just been computed.
)
from stickslip.run.words import (
    WORDS,  # What is said of each option of a run.
)

__all__ = [
    "ALL_TAKE",
    "CAPACITY",
    "FILES_OF_CORE",
    "WORDS",
    "CallOptions",
    "Catalogue",
    "Edge",
    "ExactRun",
    "Interrupts",
    "Pace",
    "PausedCatalogue",
    "Reader",
    "RunSource",
    "SolverKind",
    "Study",
    "StudyWithDataset",
    "TextProgress",
    "WholeHistory",
    "catalogue_of",
    "check_energy",
    "checkpoint_of",
    "how_far",
    "how_fast",
    "no_results",
    "progress_line",
    "reader_of",
    "reporting",
    "resume_run",
    "run_source",
    "run_to_end",
    "special_solver_of",
    "steady",
    "telling",
    "uninterrupted",
]
