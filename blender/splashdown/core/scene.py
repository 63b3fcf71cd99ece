"""The scene file: what the program simulates, in its axes (y up) and SI units."""

import re
from dataclasses import dataclass, field

import numpy as np

from . import geometry, ply

# Limits of the program.
BODY_DENSITY = (50.0, 30000.0)
FRAME_RATE = (0.1, 10000.0)
# The first line of every scene file of this extension.
HEADER = "# Written by the Blender extension of Splashdown."


@dataclass
class Domain:
    """`low`, `high`: corners, m. `open`: names of sides without a wall."""

    low: np.ndarray
    high: np.ndarray
    open: tuple = ()

    def excess(self, low, high):
        """The largest distance in m by which a box reaches out of the closed and open sides."""
        return float(max(np.max(self.low - low), np.max(high - self.high), 0.0))

    def size(self):
        return self.high - self.low


@dataclass
class Fluid:
    """A closed mesh filled with fluid. `velocity`: at the start, m/s."""

    name: str
    mesh: geometry.Mesh
    velocity: tuple = (0.0, 0.0, 0.0)


@dataclass
class Pose:
    """`time`: s. `position`: of the mesh's origin, m. `rotation`: in degrees about x, then y, then z."""

    time: float
    position: tuple
    rotation: tuple


@dataclass
class Body:
    """An obstacle. `mesh`: relative to its origin. `poses`: one if it does not move, keyframes if it does. `density`:
    kg/m^3; `None` unless the fluid moves the body. `label`: the user's name of it."""

    name: str
    mesh: geometry.Mesh
    poses: list
    density: float | None = None
    velocity: tuple = (0.0, 0.0, 0.0)
    friction: float = 0.0
    label: str = ""


@dataclass
class Emitter:
    """`speed`: m/s. `start`, `end`: s; an `end` of `None` is that of the scene. `label`: the user's name of it."""

    name: str
    outlet: geometry.Outlet
    speed: float
    start: float = 0.0
    end: float | None = None
    label: str = ""


@dataclass
class Sink:
    """A closed mesh that removes fluid."""

    name: str
    mesh: geometry.Mesh


@dataclass
class Scene:
    """`settings`: values of further keys, by section."""

    name: str
    duration: float
    frame_rate: float
    particle_spacing: float
    gravity: tuple = (0.0, -9.81, 0.0)
    domain: Domain | None = None
    fluids: list = field(default_factory=list)
    bodies: list = field(default_factory=list)
    emitters: list = field(default_factory=list)
    sinks: list = field(default_factory=list)
    settings: dict = field(default_factory=dict)


def file_name(name, taken):
    """A name of 1 to 64 letters, digits, `-` and `_` that is not in the set `taken`, to which it is added."""
    stem = re.sub(r"[^A-Za-z0-9_-]+", "_", name).strip("_")[:58] or "object"
    candidate, number = stem, 2
    while candidate.lower() in taken:
        candidate, number = f"{stem}_{number}", number + 1
    taken.add(candidate.lower())
    return candidate


def particles(scene):
    """An estimate of the number of particles at the start, from the volumes of the fluid."""
    volume = sum(abs(fluid.mesh.volume()) for fluid in scene.fluids)
    return int(volume / scene.particle_spacing**3)


def _count(number, word):
    return f"{number:,} {word}" + ("" if number == 1 else "s")


def problems(scene):
    """Everything that prevents a simulation, as texts with the names of the objects and what to do."""
    found = []
    if not (FRAME_RATE[0] <= scene.frame_rate <= FRAME_RATE[1]):
        found.append(f"{scene.frame_rate:g} frames per simulated second; {FRAME_RATE[0]:g} to {FRAME_RATE[1]:g} are allowed.")
    if scene.duration <= 0:
        found.append("The frame range is empty: set an end frame after the start frame.")
    if not scene.fluids and not scene.emitters:
        found.append("There is no fluid: give a mesh object the role Fluid or Emitter.")
    domain = scene.domain
    if domain is None:
        found.append("There is no domain: give a box the role Domain.")
    elif min(domain.size()) < 2 * scene.particle_spacing:
        found.append(
            f"The domain is {min(domain.size()):.3g} m thin, less than two particle spacings of "
            f"{scene.particle_spacing:g} m: enlarge it or reduce the spacing."
        )
    for fluid in scene.fluids:
        found += _solid_problems("The fluid", fluid.name, fluid.mesh)
        if domain is not None and len(fluid.mesh.triangles):
            found += _fluid_problems(fluid, domain)
    for sink in scene.sinks:
        found += _solid_problems("The outflow", sink.name, sink.mesh)
    for body in scene.bodies:
        if len(body.mesh.triangles) == 0:
            found.append(f'The obstacle "{body.label or body.name}" has no faces.')
        if body.density is not None and not BODY_DENSITY[0] <= body.density <= BODY_DENSITY[1]:
            found.append(
                f'The obstacle "{body.label or body.name}" has a density of {body.density:g} kg/m^3; '
                f"{BODY_DENSITY[0]:g} to {BODY_DENSITY[1]:g} are allowed."
            )
    for emitter in scene.emitters:
        position = emitter.outlet.position
        if domain is not None and domain.excess(position, position) > 0:
            found.append(f'The emitter "{emitter.label or emitter.name}" is outside the domain: move it inside.')
    return found


def _solid_problems(what, name, mesh):
    if len(mesh.triangles) == 0:
        return [f'{what} "{name}" has no faces.']
    edges = geometry.open_edges(mesh)
    if edges:
        return [
            f'{what} "{name}" is not closed: {_count(edges, "edge")} without exactly two faces of the same orientation. '
            "In Edit Mode, use Mesh > Clean Up > Merge by Distance and Fill Holes, and Mesh > Normals > "
            "Recalculate Outside."
        ]
    return []


def _fluid_problems(fluid, domain):
    low, high = fluid.mesh.bounds()
    if (high < domain.low).any() or (low > domain.high).any():
        return [f'The fluid "{fluid.name}" is outside the domain: move it inside.']
    # Objects that end at a wall may differ from it by rounding.
    excess = domain.excess(low, high)
    if excess > 1e-3 * float(max(domain.size())):
        return [f'The fluid "{fluid.name}" reaches {excess:.3g} m out of the domain: enlarge the domain or move the fluid.']
    return []


def _number(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(_number(part) for part in value) + "]"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    # Blender has single precision: more digits would be noise.
    return f"{float(value):.7g}"


def _table(header, values):
    lines = [f"{key} = {_number(value)}" for key, value in values.items() if value is not None]
    return "\n".join([header, *lines]) + "\n"


def files(scene):
    """The files of a scene: their contents (bytes) by their paths relative to the folder of `scene.toml`."""
    domain, meshes, taken = scene.domain, {}, set()

    def store(name, mesh):
        path = f"meshes/{file_name(name, taken)}.ply"
        # A mesh that is seen from inside would be a hole.
        outward = mesh.flipped() if mesh.volume() < 0 else mesh
        meshes[path] = ply.mesh_bytes(outward.vertices, outward.triangles)
        return path

    parts = [
        f"{HEADER} SI units; y is up.\n",
        _table(
            "[scene]",
            {
                "name": scene.name,
                "duration": scene.duration,
                "frame_rate": scene.frame_rate,
                "gravity": scene.gravity,
            },
        ),
        _table("[domain]", {"min": domain.low, "max": domain.high, "open": domain.open or None}),
        _table("[fluid]", {"particle_spacing": scene.particle_spacing, **scene.settings.get("fluid", {})}),
    ]
    boxes = [fluid for fluid in scene.fluids if geometry.is_box(fluid.mesh)]
    for fluid in boxes:
        low, high = (np.clip(corner, domain.low, domain.high) for corner in fluid.mesh.bounds())
        parts.append(
            _table("[[fluid.block]]", {"position": low, "size": high - low, "velocity": _unless_zero(fluid.velocity)})
        )
    for fluid in scene.fluids:
        if not any(fluid is box for box in boxes):
            path = store(fluid.name, fluid.mesh)
            parts.append(_table("[[fluid.mesh]]", {"mesh": path, "velocity": _unless_zero(fluid.velocity)}))
    for body in scene.bodies:
        parts += _body(body, store)
    for emitter in scene.emitters:
        outlet = emitter.outlet
        parts.append(
            _table(
                "[[emitter]]",
                {
                    "name": emitter.name,
                    "shape": "mesh",
                    "mesh": store(emitter.name, outlet.mesh),
                    "position": outlet.position,
                    "direction": outlet.direction,
                    "speed": emitter.speed,
                    "start": emitter.start,
                    "end": emitter.end,
                },
            )
        )
    for sink in scene.sinks:
        parts.append(_table("[[sink]]", {"name": sink.name, "shape": "mesh", "mesh": store(sink.name, sink.mesh)}))
    for section, values in scene.settings.items():
        if section != "fluid" and any(value is not None for value in values.values()):
            parts.append(_table(f"[{section}]", values))
    return {"scene.toml": "\n".join(parts).encode("utf-8"), **meshes}


def names(scene):
    """The user's names of parts of the scene, by the names that the program prints."""
    found, counts = {}, {"block": 0, "mesh": 0}
    for fluid in scene.fluids:
        kind = "block" if geometry.is_box(fluid.mesh) else "mesh"
        found[f"fluid.{kind}[{counts[kind]}]"] = f'fluid "{fluid.name}"'
        counts[kind] += 1
    for word, role, parts in (
        ("body", "obstacle", scene.bodies),
        ("emitter", "emitter", scene.emitters),
        ("sink", "outflow", scene.sinks),
    ):
        for number, part in enumerate(parts):
            ours = f'{role} "{getattr(part, "label", "") or part.name}"'
            found[f"{word}[{number}]"] = found[f'{word} "{part.name}"'] = ours
    return found


def _body(body, store):
    first = body.poses[0]
    dynamic = body.density is not None
    parts = [
        _table(
            "[[body]]",
            {
                "name": body.name,
                "mesh": store(body.name, body.mesh),
                "position": first.position,
                "rotation": first.rotation,
                "motion": "dynamic" if dynamic else None,
                "density": body.density,
                "velocity": _unless_zero(body.velocity) if dynamic else None,
                "friction": body.friction or None,
            },
        )
    ]
    if len(body.poses) > 1:
        for pose in body.poses:
            keys = {"time": pose.time, "position": pose.position, "rotation": pose.rotation}
            parts.append(_table("[[body.keyframe]]", keys))
    return parts


def _unless_zero(vector):
    return vector if any(vector) else None
