"""Triangle meshes: whether they are closed, boxes, or flat outlets."""

from dataclasses import dataclass

import numpy as np

# Relative difference from a matrix without shear.
SHEAR = 1e-3


@dataclass
class Mesh:
    """`vertices`: shape (N, 3), in m. `triangles`: shape (M, 3), counter-clockwise seen from outside."""

    vertices: np.ndarray
    triangles: np.ndarray

    def __post_init__(self):
        self.vertices = np.asarray(self.vertices, float).reshape(-1, 3)
        self.triangles = np.asarray(self.triangles, np.int64).reshape(-1, 3)

    def corners(self):
        """Shape (M, 3, 3): the vertices of the triangles."""
        return self.vertices[self.triangles]

    def bounds(self):
        """Lower and upper corner of the vertices that triangles use."""
        used = self.vertices[np.unique(self.triangles)]
        return used.min(axis=0), used.max(axis=0)

    def volume(self):
        """The enclosed volume in m^3; negative if the triangles are seen from inside."""
        a, b, c = np.moveaxis(self.corners() - self.bounds()[0], 1, 0)
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)

    def flipped(self):
        """The mesh with the other orientation."""
        return Mesh(self.vertices, self.triangles[:, ::-1])


def welded(mesh):
    """The mesh without duplicates of vertices, as along the seams of many imported files."""
    low, high = mesh.bounds()
    cell = max(float(np.max(high - low)), 1e-12) * 1e-6
    _, first, number = np.unique(
        np.round((mesh.vertices - low) / cell).astype(np.int64), axis=0, return_index=True, return_inverse=True
    )
    triangles = number.reshape(-1)[mesh.triangles]
    a, b, c = triangles.T
    return Mesh(mesh.vertices[first], triangles[(a != b) & (b != c) & (c != a)])


def open_edges(mesh):
    """The number of edges that do not join exactly two triangles of the same orientation. A closed mesh has none."""
    triangles = welded(mesh).triangles
    if len(triangles) == 0:
        return 0
    directed = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    forward = np.where(directed[:, 0] < directed[:, 1], 1, -1)
    _, number, count = np.unique(np.sort(directed, axis=1), axis=0, return_inverse=True, return_counts=True)
    balance = np.bincount(number.reshape(-1), weights=forward)
    return int(np.count_nonzero((count != 2) | (balance != 0)))


def is_box(mesh):
    """True if the closed mesh is a box along the axes: it fills its bounds."""
    low, high = mesh.bounds()
    size = np.prod(high - low)
    return bool(size > 0 and open_edges(mesh) == 0 and abs(abs(mesh.volume()) - size) < 1e-4 * size)


@dataclass
class Outlet:
    """The opening of an emitter: a closed mesh whose section through the origin, perpendicular to `direction`, is the
    opening. `position`: of the origin, m. `area`: m^2."""

    mesh: Mesh
    position: np.ndarray
    direction: np.ndarray
    area: float


def flat_outlet(mesh):
    """The [`Outlet`] of a flat mesh, which emits along its normal; `None` if it is not flat or has no area."""
    mesh = welded(mesh)
    a, b, c = np.moveaxis(mesh.corners(), 1, 0)
    products = np.cross(b - a, c - a)
    areas = 0.5 * np.linalg.norm(products, axis=1)
    if not len(areas) or areas.sum() <= 0:
        return None
    normal = products.sum(axis=0)
    length = np.linalg.norm(normal)
    low, high = mesh.bounds()
    size = float(np.max(high - low))
    # Faces that look in opposite directions have no common normal.
    if length < 1.99 * areas.sum():
        return None
    normal = normal / length
    centre = (areas[:, None] * (a + b + c) / 3).sum(axis=0) / areas.sum()
    relative = mesh.vertices - centre
    if np.abs(relative @ normal).max() > 1e-3 * size:
        return None
    count = len(relative)
    shift = 0.25 * size * normal
    directed = np.concatenate([mesh.triangles[:, [0, 1]], mesh.triangles[:, [1, 2]], mesh.triangles[:, [2, 0]]])
    pairs = {tuple(edge) for edge in directed.tolist()}
    rim = np.array([edge for edge in pairs if edge[::-1] not in pairs], np.int64).reshape(-1, 2)
    start, end = rim.T
    sides = np.concatenate(
        [np.stack([start + count, end + count, end], axis=1), np.stack([start + count, end, start], axis=1)]
    )
    solid = Mesh(
        np.concatenate([relative + shift, relative - shift]),
        np.concatenate([mesh.triangles, mesh.triangles[:, ::-1] + count, sides]),
    )
    return Outlet(solid, centre, normal, float(areas.sum()))


def split(matrix):
    """Rotation and stretch, both of shape (3, 3), whose product is `matrix`. The stretch is diagonal; it is `None` if the
    matrix has shear or is singular. A mirrored matrix has a negative stretch."""
    lengths = np.linalg.norm(matrix, axis=0)
    if lengths.min() < 1e-9 * max(lengths.max(), 1e-12):
        return np.eye(3), None
    rotation = matrix / lengths
    if np.abs(rotation.T @ rotation - np.eye(3)).max() > SHEAR:
        return np.eye(3), None
    if np.linalg.det(rotation) < 0:
        return -rotation, np.diag(-lengths)
    return rotation, np.diag(lengths)
