"""Hatchling's hook: the machine code of the engine is made when the package is built, and comes with it.

STICKSLIP_MACHINE_CODE=later leaves it out: the wheel then serves every system, and the engine is compiled when it is first needed.
"""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

SOURCE = Path(__file__).parent / "src"
CODE = "src/stickslip/machine_code"


class MachineCode(BuildHookInterface[Any]):
    """Makes the machine code before a wheel, or the files of an editable installation, are put together."""

    PLUGIN_NAME = "custom"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Make what is missing, and say that the wheel is for this system."""
        if self.target_name != "wheel" or os.environ.get("STICKSLIP_MACHINE_CODE") == "later":
            return
        paths = os.pathsep.join(filter(None, [str(SOURCE), os.environ.get("PYTHONPATH")]))
        command = [sys.executable, "-m", "stickslip.engine.build"]
        done = subprocess.run(command, env=os.environ | {"PYTHONPATH": paths}, check=False)
        if done.returncode != 0:
            raise SystemExit(
                "stickslip: the engine could not be compiled; STICKSLIP_MACHINE_CODE=later installs it without machine code"
            )
        build_data["artifacts"].append(f"/{CODE}/**")
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"
