import os
import sys

import numpy
import pysplishsplash as sph
from pysplishsplash.Utilities.SceneLoaderStructs import BoundaryData, FluidBlock

data = os.path.join(sys.prefix, "bin", "data")
base = sph.Exec.SimulatorBase()
base.init(useGui=False, sceneFile=f"{data}/Scenes/Empty.json", stopAt=0.2, outputDir=os.path.abspath("out"))
scene = sph.Exec.SceneConfiguration.getCurrent().getScene()
scene.particleRadius = 0.025
box = {"scale": [1.6, 1.0, 0.4], "translation": [0.8, 0.5, 0.2], "mapInvert": True, "isWall": True}
scene.boundaryModels.append(BoundaryData(meshFile=f"{data}/models/UnitBox.obj", **box))
scene.fluidBlocks.append(FluidBlock(id="Fluid", boxMin=[0.025] * 3, boxMax=[0.4, 0.8, 0.375]))
base.initSimulation()
base.setValueFloat(base.DATA_EXPORT_FPS, 50)
last = -1


def after_step():
    global last
    time = sph.TimeManager.getCurrent().getTime()
    if int(50 * time) > last:
        last = int(50 * time)
        fluid = sph.Simulation.getCurrent().getFluidModel(0)
        print(time, numpy.array(fluid.getFieldBuffer("position"), copy=False)[:, 0].max())


base.setTimeStepCB(after_step)
base.runSimulation()
base.cleanup()
