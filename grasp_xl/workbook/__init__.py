"""Workbooks: the thesis's sheets, read and written.  Only this package knows cells."""
