"""grasp_xl: grasp planning for sheet-metal parts, in the designer's workbook."""

__version__ = "0.1.0"
