# Opens the files of this folder in ParaView:
#     paraview --script=DIR/open_in_paraview.py        or        pvpython DIR/open_in_paraview.py [PICTURE.png]
import sys
from pathlib import Path

from paraview.simple import *

here = Path(globals().get("__file__", "open_in_paraview.py")).resolve().parent
if not (here / "fields.pvd").is_file():
    raise SystemExit(f"{here} has no fields.pvd; start ParaView in the folder of this script, or with --script=PATH")
view = GetActiveViewOrCreate("RenderView")

gas = PVDReader(FileName=str(here / "fields.pvd"))
if DIMENSION == 3:
    Show(gas, view).SetRepresentationType("Outline")
    bounds = gas.GetDataInformation().GetBounds()
    gas = Slice(Input=gas)
    gas.SliceType.Normal = [0.0, 1.0, 0.0]
    gas.SliceType.Origin = [0.5 * (bounds[k] + bounds[k + 1]) for k in (0, 2, 4)]
shown = Show(gas, view)
ColorBy(shown, ("CELLS", "density"))
shown.SetScalarBarVisibility(view, True)

if (here / "particles.pvd").is_file():
    bodies = PVDReader(FileName=str(here / "particles.pvd"))
    points = Show(bodies, view)
    points.SetRepresentationType("Point Gaussian")
    points.GaussianRadius = RADIUS
    points.ShaderPreset = "Sphere"
    ColorBy(points, ("POINTS", "plastic_strain"))
    points.SetScalarBarVisibility(view, True)

scene = GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
scene.GoToLast()
for source in GetSources().values():
    GetDisplayProperties(source, view).RescaleTransferFunctionToDataRange(False, True)
if DIMENSION == 3:
    view.CameraFocalPoint, view.CameraPosition, view.CameraViewUp = [0.0] * 3, [0.5, -1.0, 0.4], [0.0, 0.0, 1.0]
ResetCamera(view)
Render(view)
if len(sys.argv) > 1:
    view.ViewSize = [1280, 800]
    SaveScreenshot(sys.argv[1], view)
