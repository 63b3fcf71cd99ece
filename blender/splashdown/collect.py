"""Turns the objects of a Blender scene into a scene of the program."""

from dataclasses import dataclass

import numpy as np

from . import motion, playback
from .core import axes, geometry, scene as core

# Poses that differ less are equal: metres, and entries of rotation matrices.
SAME = 1e-6
# The largest turn from pose to pose that is exported as it is, in radians, and the most poses for a frame.
LARGEST_TURN = 0.5 * np.pi
MOST_STEPS = 64


def metres_per_unit(scene):
    """Metres per unit of length of a Blender scene."""
    units = scene.unit_settings
    return units.scale_length if units.system != "NONE" else 1.0


def frame_rate(scene):
    """Frames per second of the film."""
    return scene.render.fps / scene.render.fps_base


def objects_of(scene, role):
    return [obj for obj in scene.objects if obj.splashdown.role == role]


def body_names(scene):
    """The names in a run of the obstacles of a scene, by their identities."""
    taken = set()
    return {playback.identity(obj): core.file_name(obj.name, taken) for obj in objects_of(scene, "OBSTACLE")}


@dataclass
class Description:
    """A scene of the program. `problems` prevent its simulation. `bodies`: the names in the run of obstacles, by their
    identities. `floating`: the identities of those that the fluid moves."""

    scene: core.Scene
    problems: list
    warnings: list
    bodies: dict
    floating: set


def describe(context):
    """The [`Description`] of the scene of `context`. Visits the frames of the animation if there are obstacles that the
    fluid does not move, and returns to the present one."""
    scene = context.scene
    present = scene.frame_current, scene.frame_subframe
    with playback.suspended():
        try:
            if scene.frame_current != scene.frame_start or scene.frame_subframe:
                scene.frame_set(scene.frame_start)
            return _Collector(context).describe()
        finally:
            scene.frame_set(present[0], subframe=present[1])


class _Collector:
    def __init__(self, context):
        self.context = context
        self.scene = context.scene
        self.settings = self.scene.splashdown
        self.unit = metres_per_unit(self.scene)
        self.rate = frame_rate(self.scene) / self.settings.time_scale
        self.problems, self.warnings = [], []
        self.names, self.floating = {}, set()

    def describe(self):
        scene, settings = self.scene, self.settings
        self.refuse_hidden()
        described = core.Scene(
            name=core.file_name(scene.name, set()),
            duration=(scene.frame_end - scene.frame_start) / self.rate,
            frame_rate=self.rate,
            particle_spacing=settings.particle_spacing,
            gravity=self.gravity(),
            domain=self.domain(),
            settings=self.sections(),
        )
        described.fluids = self.fluids()
        described.bodies = self.bodies(described.duration)
        described.emitters = self.emitters()
        described.sinks = [core.Sink(obj.name, self.world_mesh(obj)) for obj in objects_of(scene, "OUTFLOW")]
        problems = self.problems + core.problems(described)
        return Description(described, problems, self.warnings, self.names, self.floating)

    def gravity(self):
        """In m/s^2, in the axes of the program. The interface of Blender shows it with the unit scale."""
        if not self.scene.use_gravity:
            return (0.0, 0.0, 0.0)
        gravity = self.unit * axes.to_program(self.scene.gravity)
        if self.unit != 1:
            strength = float(np.linalg.norm(gravity))
            self.warnings.append(
                f"The unit scale is {self.unit:g}, and the gravity is {strength:.3g} m/s², as the scene properties show it."
            )
        return tuple(gravity)

    def refuse_hidden(self):
        """Blender evaluates no modifiers, animation and constraints of these objects."""
        graph = self.context.evaluated_depsgraph_get()
        for obj in self.scene.objects:
            if obj.splashdown.role == "NONE" or obj.type != "MESH":
                continue
            excluded = obj.name not in self.context.view_layer.objects
            if excluded or obj.hide_viewport or not obj.evaluated_get(graph).is_evaluated:
                self.problems.append(
                    f'"{obj.name}" is disabled in viewports or in an excluded collection: enable it (monitor icon), '
                    "or set its role to None."
                )

    def sections(self):
        settings = self.settings
        if settings.material == "custom":
            fluid = {name: getattr(settings, name) for name in ("density", "viscosity", "surface_tension")}
        else:
            fluid = {"material": settings.material}
        solver = {"wall_friction": settings.wall_friction or None}
        if settings.use_surface_tension:
            solver["surface_tension"] = "akinci2013"
        return {
            "fluid": fluid,
            "solver": solver,
            "surface": {
                "cell_size": settings.cell_ratio * settings.particle_spacing,
                "smoothing_iterations": settings.smoothing,
                "kernels": "anisotropic" if settings.use_anisotropic else None,
            },
            "foam": {"enabled": settings.use_foam},
        }

    def local_mesh(self, obj):
        """The mesh with modifiers in the coordinates of the object, in the axes and units of Blender."""
        evaluated = obj.evaluated_get(self.context.evaluated_depsgraph_get())
        try:
            mesh = evaluated.to_mesh()
        except RuntimeError:
            return geometry.Mesh([], [])
        mesh.calc_loop_triangles()
        vertices = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", vertices)
        triangles = np.empty(3 * len(mesh.loop_triangles), np.int32)
        mesh.loop_triangles.foreach_get("vertices", triangles)
        evaluated.to_mesh_clear()
        return geometry.Mesh(vertices, triangles)

    def matrix(self, obj):
        """The transformation of an object to the world, shape (4, 4)."""
        return np.array(obj.evaluated_get(self.context.evaluated_depsgraph_get()).matrix_world, float)

    def placed(self, mesh, matrix):
        """A mesh under a transformation, shape (3, 3), in the axes of the program and metres."""
        vertices = self.unit * axes.to_program(mesh.vertices @ matrix.T)
        placed = geometry.Mesh(vertices, mesh.triangles)
        return placed.flipped() if np.linalg.det(matrix) < 0 else placed

    def world_mesh(self, obj):
        """The mesh of an object in the world, in the axes of the program and metres."""
        matrix = self.matrix(obj)
        placed = self.placed(self.local_mesh(obj), matrix[:3, :3])
        placed.vertices = placed.vertices + self.unit * axes.to_program(matrix[:3, 3])
        return placed

    def domain(self):
        found = objects_of(self.scene, "DOMAIN")
        if len(found) > 1:
            names = ", ".join(f'"{obj.name}"' for obj in found)
            self.problems.append(f"There are {len(found)} domains ({names}): keep one.")
        if not found:
            return None
        obj = found[0]
        mesh = self.world_mesh(obj)
        if len(mesh.triangles) == 0:
            self.problems.append(f'The domain "{obj.name}" has no faces: use a box.')
            return None
        if not geometry.is_box(mesh):
            self.problems.append(
                f'The domain "{obj.name}" is not a box along the axes: use a cube, and clear or apply its rotation '
                "(Alt-R, or Object > Apply > Rotation)."
            )
        low, high = mesh.bounds()
        sides = tuple(side for name, side, _ in axes.SIDES if name in self.settings.open_sides)
        return core.Domain(low, high, sides)

    def fluids(self):
        return [
            core.Fluid(obj.name, self.world_mesh(obj), tuple(axes.to_program(obj.splashdown.velocity)))
            for obj in objects_of(self.scene, "FLUID")
        ]

    def emitters(self):
        found = []
        for obj in objects_of(self.scene, "EMITTER"):
            outlet = geometry.flat_outlet(self.world_mesh(obj))
            if outlet is None:
                self.problems.append(
                    f'The emitter "{obj.name}" is not flat or has no faces: use a plane or a filled circle; fluid flows '
                    "along the normal of its faces."
                )
                continue
            own = obj.splashdown
            found.append(core.Emitter(obj.name, outlet, own.speed, own.start, own.end if own.use_end else None))
        taken = set()
        for emitter in found:
            emitter.label = emitter.name
            emitter.name = core.file_name(emitter.name, taken)
        return found

    def bodies(self, duration):
        objects = objects_of(self.scene, "OBSTACLE")
        moving = [obj for obj in objects if obj.splashdown.motion == "ANIMATED"]
        meshes = {obj: self.local_mesh(obj) for obj in objects}
        start = {obj: self.matrix(obj) for obj in objects}
        tracks = self.tracks(moving) if duration > 0 else {}
        self.names, bodies = body_names(self.scene), []
        for obj in objects:
            name = self.names[playback.identity(obj)]
            if obj.splashdown.motion == "DYNAMIC":
                self.floating.add(playback.identity(obj))
                # The keyframes of the bake before may say something else.
                start[obj] = motion.rest_matrix(obj) if obj.splashdown.has_rest else start[obj]
            body = self.body(obj, name, meshes[obj], start[obj], tracks.get(obj, []))
            body.label = obj.name
            bodies.append(body)
        return bodies

    def tracks(self, objects):
        """The times in s and transformations of the objects that move, in each frame and in the one after the last. That
        one gives the curve through the poses its slope at the end. All objects are sampled: constraints, drivers and
        parents may move an object that has no animation of its own."""
        tracks, angles = self.sampled(objects, 1)
        fast = {obj: turn for obj, turn in angles.items() if turn > LARGEST_TURN}
        if fast:
            # The program turns a body the shorter way from pose to pose.
            steps = min(int(np.ceil(max(fast.values()) / LARGEST_TURN - 1e-3)), MOST_STEPS)
            finer, angles = self.sampled(list(fast), steps)
            tracks.update(finer)
            for obj, turn in angles.items():
                if turn > np.pi:
                    self.warnings.append(
                        f'The obstacle "{obj.name}" turns by {np.degrees(steps * turn):,.0f}° per frame, which is too fast to '
                        "be exported: increase the frame rate."
                    )
        return {obj: track for obj, track in tracks.items() if not _same([matrix for _, matrix in track])}

    def sampled(self, objects, steps):
        """The times and transformations of objects, `steps` for each frame, and the largest turns from one to the next in
        radians."""
        tracks, largest, last = {obj: [] for obj in objects}, {obj: 0.0 for obj in objects}, {}
        count = self.scene.frame_end + 1 - self.scene.frame_start
        for number in range(steps * count + 1 if objects else 0):
            frame, step = divmod(number, steps)
            self.scene.frame_set(self.scene.frame_start + frame, subframe=step / steps)
            for obj in objects:
                tracks[obj].append((number / steps / self.rate, self.matrix(obj)))
                angles = _angles(obj)
                if obj in last:
                    largest[obj] = max(largest[obj], _turn(last[obj], angles))
                last[obj] = angles
        return tracks, largest

    def body(self, obj, name, mesh, start, track):
        own = obj.splashdown
        dynamic = own.motion == "DYNAMIC"
        if dynamic and (obj.parent or obj.constraints):
            self.problems.append(
                f'The obstacle "{obj.name}" is moved by the fluid, but has a parent or constraints: clear them.'
            )
        if dynamic and motion.is_animated(obj):
            self.problems.append(
                f'The obstacle "{obj.name}" is moved by the fluid, but its location or rotation is animated: clear these '
                "keyframes or drivers."
            )
        if not track and not dynamic:
            # A static obstacle may be sheared.
            place = tuple(self.unit * axes.to_program(start[:3, 3]))
            poses = [core.Pose(0.0, place, (0.0, 0.0, 0.0))]
            return core.Body(name, self.placed(mesh, start[:3, :3]), poses, friction=own.friction)
        rotation, stretch = geometry.split(start[:3, :3])
        poses = []
        for number, (time, matrix) in enumerate(track or [(0.0, start)]):
            turned, stretched = geometry.split(matrix[:3, :3])
            if stretched is None:
                self.problems.append(f'The obstacle "{obj.name}" moves and is sheared or flat: apply its scale (Ctrl-A).')
                break
            if number and np.abs(stretched - stretch).max() > geometry.SHEAR * np.abs(stretch).max():
                self.problems.append(f'The obstacle "{obj.name}" changes its size, which is not supported.')
                break
            place = tuple(self.unit * axes.to_program(matrix[:3, 3]))
            poses.append(core.Pose(time, place, axes.angles(axes.rotation_to_program(turned))))
        poses = poses or [core.Pose(0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))]
        scaled = self.placed(mesh, np.eye(3) if stretch is None else stretch)
        return core.Body(
            name,
            scaled,
            poses,
            own.density if dynamic else None,
            tuple(axes.to_program(own.velocity)),
            own.friction,
        )


def _same(matrices):
    return all(np.abs(matrix - matrices[0]).max() < SAME for matrix in matrices)


def _angles(obj):
    """The Euler angles of an object and of its parents; `None` for one that has no such angles."""
    found = []
    while obj:
        has_angles = obj.rotation_mode not in motion.ROTATIONS
        found.append(np.array(obj.rotation_euler) if has_angles else None)
        obj = obj.parent
    return found


def _turn(before, after):
    """The largest difference of an angle."""
    pairs = [(a, b) for a, b in zip(before, after) if a is not None and b is not None]
    return max((float(np.abs(b - a).max()) for a, b in pairs), default=0.0)
