"""Kernels: functions of which machine code is made when the package is built, how they see memory, and how they are called."""
