"""Designs of a workbook in three dimensions: a page, CAD models, a drawing, a bill of material."""
