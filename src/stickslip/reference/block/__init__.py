"""Closed forms for the spring-block."""
