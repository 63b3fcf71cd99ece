"""Conversion between the axes of Blender (z up) and those of the program (y up).

Both are right-handed: the program's (x, y, z) is Blender's (x, -z, y).
"""

import numpy as np

# Multiplied with a column vector in the axes of Blender, gives it in those of the program.
PROGRAM_FROM_BLENDER = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])

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


def to_blender(points):
    """Points or vectors, shape (N, 3) or (3,), in the axes of Blender. Keeps the type float32."""
    points = np.asarray(points)
    turned = np.empty_like(points)
    turned[..., 0] = points[..., 0]
    turned[..., 1] = -points[..., 2]
    turned[..., 2] = points[..., 1]
    return turned


def rotation_to_program(matrix):
    """The rotation matrix, shape (3, 3), that acts on the axes of the program as `matrix` does on those of Blender."""
    return PROGRAM_FROM_BLENDER @ np.asarray(matrix, float) @ PROGRAM_FROM_BLENDER.T


def quaternion_to_blender(xyzw):
    """A unit quaternion x, y, z, w of the program as w, x, y, z in the axes of Blender."""
    x, y, z, w = xyzw
    return (w, x, -z, y)


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
