"""From gripper elements and faces of a part to an option space; no workbook is known."""
