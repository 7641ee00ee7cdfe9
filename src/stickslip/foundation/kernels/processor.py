"""The processor that machine code is made for: the highest level that this one reaches, so that one file serves many of them.

A level is a set of instructions that processors of many makers have. All of them run the same code, whose speed could not be told
from that of code for the one at hand (`benchmarks/README.md`). A processor below every level gets code of its own.
"""

from __future__ import annotations

import hashlib
import os
import platform
from dataclasses import dataclass
from functools import cache
from typing import Any

import llvmlite.binding as llvm

from stickslip.foundation.errors import InputError

llvm.initialize_native_target()
llvm.initialize_native_asmprinter()

OPTIMISED = 3
"""How much LLVM optimises: as much as it does by default."""


@dataclass(frozen=True)
class Processor:
    """What machine code is made for: a name for files, LLVM's names of the processor and its features, and the number of lanes."""

    name: str
    cpu: str
    features: str
    lanes: int

    def machine(self) -> Any:
        """Return LLVM's description of the processor, which makes machine code and says how it must be loaded."""
        target = llvm.Target.from_triple(llvm.get_process_triple())
        reloc = "static" if target.name.startswith("x86") else "default"
        return target.create_target_machine(
            opt=OPTIMISED, cpu=self.cpu, features=self.features, reloc=reloc, codemodel="jitdefault", jit=True
        )

    def optimised(self, module: Any) -> bytes:
        """Return the optimised machine code of a module of LLVM's, as an object file."""
        machine = self.machine()
        passes = llvm.create_pass_builder(machine, llvm.create_pipeline_tuning_options(OPTIMISED))
        passes.getModulePassManager().run(module, passes)
        return bytes(machine.emit_object(module))


LEVELS_OF_ARCHITECTURE = {
    "x86_64": ("x86-64-v3", {"avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe"}),
    "aarch64": ("generic", {"neon"}),
}
"""The level for each architecture, by LLVM's name, and features by which a processor is known to reach it."""
ALIASES = {"AMD64": "x86_64", "arm64": "aarch64"}
"""Other names that systems have for these architectures."""


@cache
def this_processor() -> Processor:
    """Return the level of this processor; STICKSLIP_PROCESSOR=native asks for code of its own."""
    wanted, has = os.environ.get("STICKSLIP_PROCESSOR", ""), llvm.get_host_cpu_features()
    architecture = ALIASES.get(platform.machine(), platform.machine())
    level, needs = LEVELS_OF_ARCHITECTURE.get(architecture, ("", {""}))
    if wanted not in ("", "native"):
        raise InputError(f"STICKSLIP_PROCESSOR must be empty or native, got {wanted!r}")
    if not wanted and all(has.get(feature, False) for feature in needs):
        return _named(level if "x86" in level else architecture, level, "")
    features = has.flatten()
    return _named(f"{architecture}-own-{hashlib.sha256(features.encode()).hexdigest()[:8]}", llvm.get_host_cpu_name(), features)


def _named(name: str, cpu: str, features: str) -> Processor:
    system = platform.system().lower()
    return Processor(f"{system}-{name}", cpu, features, 8 if "x86" in name else 4)


PROCESSOR = this_processor()
"""What all machine code of this process is made for."""
