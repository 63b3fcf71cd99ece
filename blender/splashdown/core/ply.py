"""The PLY files of the program: binary, little-endian, with a vertex element and triangles."""

import os
from dataclasses import dataclass, field

import numpy as np

# A header of the program has some 500 bytes.
LONGEST_HEADER = 64 * 1024
TYPES = {
    "char": "i1",
    "uchar": "u1",
    "short": "<i2",
    "ushort": "<u2",
    "int": "<i4",
    "uint": "<u4",
    "float": "<f4",
    "double": "<f8",
    "int8": "i1",
    "uint8": "u1",
    "int16": "<i2",
    "uint16": "<u2",
    "int32": "<i4",
    "uint32": "<u4",
    "float32": "<f4",
    "float64": "<f8",
}


class FrameError(Exception):
    """A file that cannot be used. The text says why, without the name of the file."""


@dataclass
class Header:
    """`vertex`: the type of a vertex. `face`: the type of a triangle, or `None`. `start`: bytes before the vertices."""

    vertices: int
    vertex: np.dtype
    faces: int
    face: np.dtype | None
    start: int

    def size(self):
        """Bytes of the complete file."""
        faces = self.faces * self.face.itemsize if self.face else 0
        return self.start + self.vertices * self.vertex.itemsize + faces


@dataclass
class Frame:
    """Data of a file in the axes of the program. `positions`: shape (N, 3), float32, m. `triangles`: shape (M, 3),
    int32. `values`: further columns by name, shape (N,)."""

    positions: np.ndarray
    triangles: np.ndarray
    values: dict = field(default_factory=dict)

    def velocities(self):
        """Shape (N, 3), float32, m/s; zero if the file has none."""
        columns = [self.values.get(name) for name in ("vx", "vy", "vz")]
        if any(column is None for column in columns):
            return np.zeros_like(self.positions)
        return np.stack(columns, axis=1).astype(np.float32)


def parse_header(data):
    """The [`Header`] at the start of `data` (bytes). Raises [`FrameError`]."""
    marker = b"end_header\n"
    end = data.find(marker)
    if not data.startswith(b"ply"):
        raise FrameError("it is not a PLY file")
    if end < 0:
        raise FrameError("its header is incomplete")
    lines = data[:end].decode("ascii", "replace").split("\n")
    elements = []
    binary = False
    for words in (line.split() for line in lines[1:]):
        if words[:1] == ["format"]:
            binary = words[1:2] == ["binary_little_endian"]
        elif words[:1] == ["element"] and len(words) == 3 and words[2].isdecimal():
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"] and elements:
            elements[-1][2].append(words[1:])
    if not binary:
        raise FrameError("it is not a binary, little-endian PLY file")
    found = {name: (count, properties) for name, count, properties in elements}
    if [name for name, _, _ in elements] not in (["vertex"], ["vertex", "face"]):
        raise FrameError("it has other elements than vertices and faces")
    count, properties = found["vertex"]
    columns = [(name, TYPES[kind]) for kind, name in (p for p in properties if len(p) == 2) if kind in TYPES]
    names = [name for name, _ in columns]
    if len(columns) != len(properties) or len(set(names)) != len(names) or not {"x", "y", "z"} <= set(names):
        raise FrameError("its vertices have no positions, or properties that are not numbers")
    faces, face = 0, None
    if "face" in found:
        faces, lists = found["face"]
        if len(lists) != 1 or lists[0][:1] != ["list"] or len(lists[0]) != 4:
            raise FrameError("its faces have other properties than a list of vertices")
        kinds = [TYPES.get(kind) for kind in lists[0][1:3]]
        if None in kinds or "f" in "".join(kinds):
            raise FrameError("its faces are not lists of whole numbers")
        face = np.dtype([("count", kinds[0]), ("indices", kinds[1], (3,))])
    return Header(count, np.dtype(columns), faces, face, end + len(marker))


def _open(path):
    try:
        return open(path, "rb")
    except OSError as error:
        raise FrameError(error.strerror or str(error)) from error


def check(path):
    """Checks the header of a file and that the file is complete. Reads only its start. Raises [`FrameError`]."""
    with _open(path) as file:
        header = parse_header(file.read(LONGEST_HEADER))
        size = os.fstat(file.fileno()).st_size
    if size < header.size():
        raise FrameError(f"it is truncated: {size} of {header.size()} bytes")


def read(path):
    """Reads a [`Frame`]. Raises [`FrameError`] if the file is missing, truncated or invalid."""
    with _open(path) as file:
        data = file.read()
    header = parse_header(data[:LONGEST_HEADER])
    if len(data) < header.size():
        raise FrameError(f"it is truncated: {len(data)} of {header.size()} bytes")
    vertices = np.frombuffer(data, header.vertex, header.vertices, header.start)
    positions = np.stack([vertices[axis].astype(np.float32) for axis in "xyz"], axis=1)
    if not np.isfinite(positions).all():
        raise FrameError("it has positions that are not finite")
    triangles = np.empty((0, 3), np.int32)
    if header.face and header.faces:
        start = header.start + header.vertices * header.vertex.itemsize
        faces = np.frombuffer(data, header.face, header.faces, start)
        if (faces["count"] != 3).any():
            raise FrameError("it has faces that are not triangles")
        indices = faces["indices"].astype(np.int64)
        if indices.min() < 0 or indices.max() >= header.vertices:
            raise FrameError("its triangles refer to vertices that do not exist")
        a, b, c = indices.T
        triangles = indices[(a != b) & (b != c) & (c != a)].astype(np.int32)
    names = [name for name in header.vertex.names if name not in "xyz"]
    return Frame(positions, triangles, {name: vertices[name] for name in names})


def mesh_bytes(vertices, triangles):
    """A PLY file with these vertices, shape (N, 3), and triangles, shape (M, 3)."""
    vertices = np.asarray(vertices, "<f4").reshape(-1, 3)
    triangles = np.asarray(triangles).reshape(-1, 3)
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    faces = np.empty(len(triangles), np.dtype([("count", "u1"), ("indices", "<i4", (3,))]))
    faces["count"], faces["indices"] = 3, triangles
    return header.encode("ascii") + vertices.tobytes() + faces.tobytes()
