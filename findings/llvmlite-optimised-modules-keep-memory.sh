#!/usr/bin/env bash
# llvmlite 0.50.0 keeps memory of each module that is optimised, also when the module, its passes and its context are gone.
#
# A process that compiles new functions for days grows with their number. What is seen here, without any other software:
#   parsed only   a module that is parsed, verified and dropped keeps next to nothing
#   optimised     a module that went through the pipeline of `create_pass_builder` as well keeps some 0.4 kB of each instruction,
#                 here 0.4 MB of 1000
# A context of its own for each module, dropped with it, changes nothing. Exit code 0: it is still so; 1: it is no longer so.
#
# Usage: findings/llvmlite-optimised-modules-keep-memory.sh [PYTHON]   (makes and removes a virtual environment)
set -euo pipefail

python=${1:-python3}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" -m venv "$folder/venv"
"$folder/venv/bin/pip" --disable-pip-version-check --quiet install llvmlite==0.50.0

"$folder/venv/bin/python" - <<'PYTHON'
import gc
import os
import sys

import llvmlite
import llvmlite.binding as llvm

llvm.initialize_native_target()
llvm.initialize_native_asmprinter()
MODULES = 30
INSTRUCTIONS = 1000
TARGET = llvm.Target.from_triple(llvm.get_process_triple())


def text(number: int) -> str:
    """Return a module with one function, different for each number."""
    lines = "\n".join(f"  %x{n + 1} = fadd double %x{n}, {float(number + n)!r}" for n in range(INSTRUCTIONS))
    return f"define double @f{number}(double %x0) {{\n{lines}\n  ret double %x{INSTRUCTIONS}\n}}\n"


def resident() -> int:
    """Return the memory of this process, bytes."""
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def parsed(number: int, context):
    module = llvm.parse_assembly(text(number), context)
    module.verify()
    return module


def optimised(number: int, context):
    module, machine = parsed(number, context), TARGET.create_target_machine(opt=3)
    passes = llvm.create_pass_builder(machine, llvm.create_pipeline_tuning_options(3))
    passes.getModulePassManager().run(module, passes)
    return module


def kept(make, own_context: bool) -> float:
    """Return the memory that each of many modules keeps after it was dropped, MB."""
    for number in range(10):  # what is made once
        make(number, llvm.create_context() if own_context else None)
    gc.collect()
    before = resident()
    for number in range(10, 10 + MODULES):
        make(number, llvm.create_context() if own_context else None)
    gc.collect()
    return (resident() - before) / MODULES / 1e6


print(f"llvmlite {llvmlite.__version__}, LLVM {'.'.join(map(str, llvm.llvm_version_info))}: MB kept by each module")
found = {}
for name, make in (("parsed only", parsed), ("optimised", optimised)):
    for own in (False, True):
        found[name, own] = kept(make, own)
        print(f"{name:12} {'own context' if own else 'global context':15} {found[name, own]:.3f}")
still = all(found["parsed only", own] < 0.05 and found["optimised", own] > 0.2 for own in (False, True))
print("as described" if still else "no longer as described: read the head of this script, and use what has changed")
sys.exit(0 if still else 1)
PYTHON
