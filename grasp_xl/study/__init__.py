"""Studies: many runs of many parts, and what they say together (chapter 6)."""
