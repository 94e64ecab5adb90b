"""Searches: they are given an option space and rules, and return results; no file is known."""
