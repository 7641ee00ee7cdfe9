"""Kernels: functions that become machine code when the package is built, how they see memory, and how they are called."""
