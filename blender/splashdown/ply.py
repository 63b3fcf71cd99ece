"""Binary PLY files of Splashdown. Needs NumPy, not Blender."""

import numpy as np

TYPES = {
    "char": "i1", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4",
    "float": "<f4", "double": "<f8", "int8": "i1", "uint8": "u1", "int32": "<i4", "uint32": "<u4",
    "float32": "<f4", "float64": "<f8",
}  # fmt: skip
HEADER_LIMIT = 16384


class PlyError(ValueError):
    """A file that is truncated or not a binary PLY file of triangles or points."""


def read_header(file):
    """The elements of an open file: a list of (name, count, dtype) and the offset of the data in bytes.

    Raises PlyError if the header is incomplete or describes something else.
    """
    start = file.read(HEADER_LIMIT)
    end = start.find(b"end_header\n")
    if not start.startswith(b"ply\n") or end < 0:
        raise PlyError("no complete PLY header")
    elements = []
    is_binary = False
    try:
        for line in start[:end].decode("ascii").splitlines():
            words = line.split()
            if words[:2] == ["format", "binary_little_endian"]:
                is_binary = True
            elif words[:1] == ["element"]:
                elements.append((words[1], int(words[2]), []))
            elif words[:2] == ["property", "list"]:
                elements[-1][2].append(("count", TYPES[words[2]]))
                elements[-1][2].append(("corners", TYPES[words[3]], 3))
            elif words[:1] == ["property"]:
                elements[-1][2].append((words[2], TYPES[words[1]]))
        elements = [(name, count, np.dtype(fields)) for name, count, fields in elements]
    except (IndexError, KeyError, ValueError) as error:
        raise PlyError(f"unknown PLY header: {error}") from error
    if not is_binary:
        raise PlyError("not a binary little-endian PLY file")
    return elements, end + len(b"end_header\n")


def is_complete(path):
    """Whether a file has a valid header and at least as many bytes as the header announces."""
    try:
        with open(path, "rb") as file:
            elements, offset = read_header(file)
            file.seek(0, 2)
            return file.tell() >= offset + sum(count * dtype.itemsize for _, count, dtype in elements)
    except (OSError, PlyError):
        return False


def read(path):
    """The elements of a file as a dictionary of structured arrays.

    Raises PlyError if the file is truncated or has faces other than triangles, and OSError if it cannot be read.
    """
    with open(path, "rb") as file:
        elements, offset = read_header(file)
        file.seek(offset)
        arrays = {}
        for name, count, dtype in elements:
            data = file.read(count * dtype.itemsize)
            if len(data) < count * dtype.itemsize:
                raise PlyError("truncated")
            arrays[name] = np.frombuffer(data, dtype)
    if "face" in arrays and not (arrays["face"]["count"] == 3).all():
        raise PlyError("a face is not a triangle")
    return arrays


def to_blender(x, y, z):
    """Columns with y up as an array of shape (n, 3) with z up."""
    return np.stack([x, -z, y], axis=-1).astype(np.float32)


def vectors(array, names):
    """Three fields of a structured array with z up, or None if one is missing."""
    if any(name not in (array.dtype.names or ()) for name in names):
        return None
    return to_blender(*(array[name] for name in names))
