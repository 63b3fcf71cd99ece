"""Keyframes for objects that the fluid moves, from the tables of a run."""

import bpy
from mathutils import Matrix, Quaternion, Vector

from .core import axes


def remember(obj):
    """Stores the pose of an object, so that [`restore`] can bring it back."""
    if not obj.splashdown.has_rest_pose:
        matrix = obj.matrix_basis
        obj.splashdown.rest_pose = [matrix[row][column] for row in range(4) for column in range(4)]
        obj.splashdown.has_rest_pose = True


def restore(obj):
    """Removes the keyframes of a run and brings the pose from before back."""
    own = obj.splashdown
    if own.has_rest_pose:
        obj.animation_data_clear()
        values = list(own.rest_pose)
        obj.matrix_basis = Matrix([values[4 * row : 4 * row + 4] for row in range(4)])
        own.has_rest_pose = False


def apply(obj, rows, start_frame, frame_interval, metres_per_unit):
    """Sets keyframes of place and rotation.

    `rows`: time (s), position (m) and unit quaternion x, y, z, w in the axes of the program. `frame_interval`: simulated
    time between frames, s.
    """
    obj.animation_data_clear()
    obj.rotation_mode = "QUATERNION"
    editing = bpy.context.preferences.edit
    before = editing.keyframe_new_interpolation_type
    editing.keyframe_new_interpolation_type = "LINEAR"
    last = None
    try:
        for time, position, quaternion in rows:
            frame = start_frame + time / frame_interval
            obj.location = Vector(axes.to_blender(position)) / metres_per_unit
            turned = Quaternion(axes.quaternion_to_blender(quaternion))
            # A quaternion and its negative are the same rotation; between keyframes the nearer one is meant.
            if last is not None and last.dot(turned) < 0:
                turned.negate()
            obj.rotation_quaternion = last = turned
            obj.keyframe_insert("location", frame=frame)
            obj.keyframe_insert("rotation_quaternion", frame=frame)
    finally:
        editing.keyframe_new_interpolation_type = before
