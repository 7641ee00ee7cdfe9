"""Leaps over steady sliding before each kind of driver, a module for each kind."""
