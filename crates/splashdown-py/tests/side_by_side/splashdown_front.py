import splashdown

scene = splashdown.Scene(
    scene={"name": "dam-break", "duration": 1.0},
    domain={"min": [0, 0, 0], "max": [1.6, 1.0, 0.4]},
    fluid={"particle_spacing": 0.05, "block": [{"position": [0, 0, 0], "size": [0.4, 0.8, 0.4]}]},
)
for frame in splashdown.Run(scene, frames=10, surface=False):
    print(frame.time, frame.particles.positions[:, 0].max())
