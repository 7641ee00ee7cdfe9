# What others take from problem.scenarios. Each name is imported when it is first used; all else is the room's own.

from stickslip.problem.scenarios.entries import (
    Source,  # The origin of a document: its name in messages and, for a document in a file, the folder of its data files.
    describe,  # Return the meaning, the unit and the range of a field as text for users.
    key_of,  # Return the key of a field in a scenario.
    read_typed,  # Return in SI what a user typed, a number or a text with a unit.
    to_table,  # Return a body, a law or a loading history as a table of a scenario, with numbers that read back to the last digit.
    typed_number,  # Return a text as a number if it is one, otherwise the text without leading and trailing spaces.
)
from stickslip.problem.scenarios.parameter_paths import (
    YES_OR_NO,  # Declares a parameter that is true or false.
    # A parameter of a scenario: its place in the file, and its declaration as a quantity or as one of several words.
    ParameterPath,
    document_with,  # Return the document of a scenario, in SI, with other values of parameters.
    find_parameter,  # Return the parameter with this name, or whose name ends with it.
    place_of,  # Return the table or list in a document that has a value with this name, and its key or index there.
    put_into,  # Return the document of a scenario as somebody wrote it, with other values, and all else as it was written.
    values_in,  # Yield every parameter that has a value in the file of a scenario, with the value (SI).
    with_values,  # Return a scenario with other values of some parameters, as `Scenario.with_values` does; `where` begins messages.
)
from stickslip.problem.scenarios.record_of_file import (
    fields_of_file,  # Return the fields of a record in a file, wherever it is.
)
from stickslip.problem.scenarios.scenario import (
    LARGEST_TEXT,  # Largest number of characters of a scenario, as in a file of results, which holds the points of data files, too.
    UNNAMED,  # Name of a scenario that has none of its own.
    Scenario,  # A problem, and how long (s, or a text with a unit) and how accurately to run it.
    doubts,  # Return the questions about the numbers of a problem, one line each.
    load_scenario,  # Read a scenario file (TOML), or a bundled scenario by its name.
    read_scenario,  # Read a scenario from TOML text; `file` is the name of the text in messages.
    scenario_of,  # Return a scenario from a parsed TOML document.
)
from stickslip.problem.scenarios.schema import (
    ONE_WAY,  # Meaning of the key one_way.
    TABLES,  # The tables of a scenario; extensions add others.
    TABLES_WITH_KIND,  # Tables that must have a key `kind`, each with the classes that it may name.
    # A key of a table: the function that converts and checks its value, its default (MISSING if it must be given), its meaning.
    Key,
    check_rule,  # Return the name of a selection rule if there is such a rule.
    # Return every field of a table by its key, with its default: quantities, and other fields of a law or a loading history.
    entries_in,
    kind_of,  # Return the class that `kind` names in a table.
    quantities_in,  # Return each quantity of a table with its default (MISSING if there is none).
    read_as,  # Return a value of a key if it is of a type, `wanted` in words.
    read_part,  # Return the body, law or loading history that a table describes.
    # Return a message without its first words, such as "ElasticSlab: ": the author of a file knows tables, not classes.
    without_owner,
)
from stickslip.problem.scenarios.source import (
    check_solved_by_core,  # Refuse a scenario whose own problem is not what is solved, as all but runs need it.
    read_problem,  # Return a problem itself, or that of a scenario, which may be given as to `read_source`.
    read_source,  # Return the scenario of a problem with a `duration`, a scenario itself, or that of a bundled name or a file.
)
from stickslip.problem.scenarios.table import (
    LateTable,  # A table whose module is imported when a scenario has it, or when somebody asks for more than its examples.
    ScenarioTable,  # What a table of an extension holds, and what it means.
)
from stickslip.problem.scenarios.templates import (
    example_of,  # Return the example values of a law by their keys in a scenario, for a body whose loads have this unit.
    template,  # Return a commented scenario as TOML text: a starter, one of `library.STARTERS`, or a bundled scenario.
    # Return a starter or a bundled scenario with another friction law without a state, as commented TOML text to the last digit.
    with_law,
)
from stickslip.problem.scenarios.text_of_files import (
    LARGEST_SCENARIO_FILE,  # Size (bytes) of the largest scenario file that is read: scenarios are untrusted.
    # Return True for a text that is the name of a scenario, bundled or in TOML, where the name of another file is expected.
    is_scenario_name,
    text_of,  # Return the text in the content of a scenario file, called `file` in messages.
)

__all__ = [
    "LARGEST_SCENARIO_FILE",
    "LARGEST_TEXT",
    "ONE_WAY",
    "TABLES",
    "TABLES_WITH_KIND",
    "UNNAMED",
    "YES_OR_NO",
    "Key",
    "LateTable",
    "ParameterPath",
    "Scenario",
    "ScenarioTable",
    "Source",
    "check_rule",
    "check_solved_by_core",
    "describe",
    "document_with",
    "doubts",
    "entries_in",
    "example_of",
    "fields_of_file",
    "find_parameter",
    "is_scenario_name",
    "key_of",
    "kind_of",
    "load_scenario",
    "place_of",
    "put_into",
    "quantities_in",
    "read_as",
    "read_part",
    "read_problem",
    "read_scenario",
    "read_source",
    "read_typed",
    "scenario_of",
    "template",
    "text_of",
    "to_table",
    "typed_number",
    "values_in",
    "with_law",
    "with_values",
    "without_owner",
]
