"""Closed-form solutions for the spring-block."""
