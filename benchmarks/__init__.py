"""Measurements of speed and memory; see README.md for the commands and the numbers."""
