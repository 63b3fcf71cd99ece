"""Conversion between the axes of Blender (z up) and those of the program.

Scenes of the extension have y up: the program's (x, y, z) is Blender's (x, -z, y). Other scenes may have another axis up,
against their gravity. All conversions are rotations.
"""

import numpy as np

# Multiplied with a column vector in the axes of Blender, gives it in those of the program.
PROGRAM_FROM_BLENDER = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])

# For each axis that is up in a scene: which of its coordinates are x, y and z in Blender, and their signs.
TURNS = {
    "Y": ((0, 2, 1), (1, -1, 1)),
    "-Y": ((0, 2, 1), (1, 1, -1)),
    "Z": ((0, 1, 2), (1, 1, 1)),
    "-Z": ((0, 1, 2), (1, -1, -1)),
    "X": ((1, 2, 0), (1, 1, 1)),
    "-X": ((1, 2, 0), (1, -1, -1)),
}

# The sides of a domain: the name in the axes of Blender, that in scene files, and a label.
SIDES = (
    ("NEGATIVE_X", "x_min", "-X"),
    ("POSITIVE_X", "x_max", "+X"),
    ("NEGATIVE_Y", "z_max", "-Y"),
    ("POSITIVE_Y", "z_min", "+Y"),
    ("NEGATIVE_Z", "y_min", "-Z"),
    ("POSITIVE_Z", "y_max", "+Z"),
)


def to_program(points):
    """Points or vectors, shape (N, 3) or (3,), in the axes of the program."""
    return np.asarray(points, float) @ PROGRAM_FROM_BLENDER.T


def up_of(gravity):
    """The key of [`TURNS`] opposite to the largest component of a gravity, shape (3,): y without a gravity."""
    gravity = np.asarray(gravity, float)
    axis = int(np.abs(gravity).argmax())
    if not np.isfinite(gravity).all() or gravity[axis] == 0:
        return "Y"
    return ("-" if gravity[axis] > 0 else "") + "XYZ"[axis]


def to_blender(points, up="Y"):
    """Points or vectors of a scene with this axis up, shape (N, 3) or (3,), in the axes of Blender. Keeps the type float32."""
    points = np.asarray(points)
    order, signs = TURNS[up]
    return points[..., order] * np.array(signs, points.dtype)


def rotation_to_program(matrix):
    """The rotation matrix, shape (3, 3), that acts on the axes of the program as `matrix` does on those of Blender."""
    return PROGRAM_FROM_BLENDER @ np.asarray(matrix, float) @ PROGRAM_FROM_BLENDER.T


def quaternion_to_blender(xyzw, up="Y"):
    """A unit quaternion x, y, z, w of a scene with this axis up as w, x, y, z in the axes of Blender."""
    # Its first three numbers are a vector along the axis of the rotation.
    return (xyzw[3], *to_blender(np.array(xyzw[:3], float), up).tolist())


def angles(matrix):
    """Rotations in degrees about x, then y, then z, as in scene files, of a rotation matrix of shape (3, 3)."""
    m = np.asarray(matrix, float)
    across = np.hypot(m[0, 0], m[1, 0])
    y = np.arctan2(-m[2, 0], across)
    if across > 1e-7:
        x, z = np.arctan2(m[2, 1], m[2, 2]), np.arctan2(m[1, 0], m[0, 0])
    else:
        # x and z turn about the same axis, so that one of them is enough.
        x, z = np.arctan2(-m[1, 2], m[1, 1]), 0.0
    return tuple(float(angle) for angle in np.degrees([x, y, z]))
