Attribute VB_Name = "GraspXL"
Option Explicit

' The buttons of a grasp_xl workbook: each runs a command on the open workbook.

Public Sub CheckGrasp()
    RunPython "import grasp_xl.live; grasp_xl.live.check()"
End Sub

Public Sub RunGrasp()
    RunPython "import grasp_xl.live; grasp_xl.live.run()"
End Sub

Public Sub ProveGrasp()
    RunPython "import grasp_xl.live; grasp_xl.live.prove()"
End Sub

Public Sub StopGrasp()
    RunPython "import grasp_xl.live; grasp_xl.live.stop()"
End Sub
