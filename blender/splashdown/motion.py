"""Keyframes for objects that the fluid moves, from the tables of a run."""

import bpy
import numpy as np
from mathutils import Euler, Matrix, Quaternion, Vector

from .core import axes, geometry

# The properties that a bake sets.
PATHS = ("location", "rotation_quaternion")
ROTATIONS = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}
# A mark of actions that a bake has made.
OURS = "splashdown"


def rotation_name(mode):
    """The property that holds the rotation of an object in a rotation mode."""
    return ROTATIONS.get(mode, "rotation_euler")


def remember(obj):
    """Stores location and rotation of an object, so that [`restore`] can bring them back."""
    own = obj.splashdown
    if not own.has_rest:
        values = list(getattr(obj, rotation_name(obj.rotation_mode)))
        own.rest_location, own.rest_mode = obj.location, obj.rotation_mode
        own.rest_rotation = (values + [0.0])[:4]
        own.has_rest = True


def rest_matrix(obj):
    """The transformation of an object without parent, shape (4, 4), with the pose from before a bake if it has one."""
    own = obj.splashdown
    if not own.has_rest:
        return np.array(obj.matrix_basis, float)
    values, mode = list(own.rest_rotation), own.rest_mode
    if mode == "QUATERNION":
        turned = obj.delta_rotation_quaternion.to_matrix() @ Quaternion(values).normalized().to_matrix()
    elif mode == "AXIS_ANGLE":
        turned = Matrix.Rotation(values[0], 3, values[1:])
    else:
        turned = obj.delta_rotation_euler.to_matrix() @ Euler(values[:3], mode).to_matrix()
    matrix = np.eye(4)
    matrix[:3, :3] = np.array(turned) * _scale(obj)
    matrix[:3, 3] = np.array(own.rest_location) + np.array(obj.delta_location)
    return matrix


def _scale(obj):
    return np.array(obj.scale, float) * np.array(obj.delta_scale, float)


def _curves(obj):
    """The curves of the action of an object; `None` without an action."""
    data = obj.animation_data
    if data is None or data.action is None:
        return None
    if not hasattr(data, "action_slot"):
        return data.action.fcurves
    # Blender 4.4 and newer.
    if data.action_slot is None:
        return None
    for layer in data.action.layers:
        for strip in layer.strips:
            bag = strip.channelbag(data.action_slot)
            if bag is not None:
                return bag.fcurves
    return None


def is_animated(obj):
    """Whether the user has animated the location or rotation of an object."""
    curves = _curves(obj) or ()
    paths = {*PATHS, "rotation_euler", "rotation_axis_angle"}
    has_drivers = obj.animation_data is not None and any(driver.data_path in paths for driver in obj.animation_data.drivers)
    return has_drivers or (not obj.splashdown.has_rest and any(curve.data_path in paths for curve in curves))


def _remove_curves(obj):
    """Removes the curves of a bake, and its action if nothing else is in it."""
    curves = _curves(obj)
    if curves is None:
        return
    for curve in [curve for curve in curves if curve.data_path in PATHS]:
        curves.remove(curve)
    action = obj.animation_data.action
    if not len(curves) and action.get(OURS):
        obj.animation_data_clear()
        if not action.users:
            bpy.data.actions.remove(action)


def restore(obj):
    """Removes the keyframes of a run and brings the pose from before back."""
    own = obj.splashdown
    if own.has_rest:
        _remove_curves(obj)
        obj.location, obj.rotation_mode = own.rest_location, own.rest_mode
        name = rotation_name(own.rest_mode)
        setattr(obj, name, list(own.rest_rotation)[: len(getattr(obj, name))])
        own.has_rest = False


def apply(obj, rows, start_frame, frame_interval, metres_per_unit, up="Y"):
    """Sets keyframes of place and rotation.

    `rows`: time (s), position (m) and unit quaternion x, y, z, w in the axes of the program. `frame_interval`: simulated
    time between frames, s. `up`: the axis of the program that is up.
    """
    remember(obj)
    # The export turns a mirrored object in another way than Blender: a constant rotation between the two.
    exported, _ = geometry.split(rest_matrix(obj)[:3, :3])
    own = rest_matrix(obj)[:3, :3] / _scale(obj)
    after = Matrix((exported.T @ own).tolist()).to_quaternion()
    _remove_curves(obj)
    if obj.animation_data and obj.animation_data.action and obj.animation_data.action.users > 1:
        obj.animation_data.action = obj.animation_data.action.copy()
    has_action = obj.animation_data is not None and obj.animation_data.action is not None
    obj.rotation_mode = "QUATERNION"
    before = obj.delta_rotation_quaternion.inverted()
    shift = Vector(obj.delta_location)
    editing = bpy.context.preferences.edit
    interpolation = editing.keyframe_new_interpolation_type
    editing.keyframe_new_interpolation_type = "LINEAR"
    last = None
    try:
        for time, position, quaternion in rows:
            frame = start_frame + time / frame_interval
            obj.location = Vector(axes.to_blender(position, up)) / metres_per_unit - shift
            turned = before @ Quaternion(axes.quaternion_to_blender(quaternion, up)) @ after
            # A quaternion and its negative are the same rotation; between keyframes the nearer one is meant.
            if last is not None and last.dot(turned) < 0:
                turned.negate()
            obj.rotation_quaternion = last = turned
            for path in PATHS:
                obj.keyframe_insert(path, frame=frame)
    finally:
        editing.keyframe_new_interpolation_type = interpolation
    if not has_action and obj.animation_data is not None and obj.animation_data.action is not None:
        obj.animation_data.action[OURS] = True
