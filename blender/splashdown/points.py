"""A group of geometry nodes that turns the vertices of a mesh into spheres."""

import bpy

from . import materials

NAME = "Splashdown Points"


def group():
    """The group. It is made once and then belongs to the user."""
    if NAME in bpy.data.node_groups:
        return bpy.data.node_groups[NAME]
    made = bpy.data.node_groups.new(NAME, "GeometryNodeTree")
    made.is_modifier = True
    interface = made.interface
    interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    factor = interface.new_socket("Radius Factor", in_out="INPUT", socket_type="NodeSocketFloat")
    factor.default_value, factor.min_value = 1.0, 0.0
    interface.new_socket("Material", in_out="INPUT", socket_type="NodeSocketMaterial")
    interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    nodes, links = made.nodes, made.links
    start, end = nodes.new("NodeGroupInput"), nodes.new("NodeGroupOutput")
    radius = nodes.new("GeometryNodeInputNamedAttribute")
    radius.data_type = "FLOAT"
    radius.inputs["Name"].default_value = "radius"
    scaled = nodes.new("ShaderNodeMath")
    scaled.operation = "MULTIPLY"
    points = nodes.new("GeometryNodeMeshToPoints")
    material = nodes.new("GeometryNodeSetMaterial")
    for column, node in enumerate((start, radius, scaled, points, material, end)):
        node.location = (220 * column, -200 if node is radius else 0)
    links.new(next(socket for socket in radius.outputs if socket.enabled), scaled.inputs[0])
    links.new(start.outputs["Radius Factor"], scaled.inputs[1])
    links.new(start.outputs["Geometry"], points.inputs["Mesh"])
    links.new(scaled.outputs[0], points.inputs["Radius"])
    links.new(points.outputs[0], material.inputs["Geometry"])
    links.new(start.outputs["Material"], material.inputs["Material"])
    links.new(material.outputs[0], end.inputs[0])
    return made


def add_to(obj, material):
    """Adds the group to an object unless it has it. A material that the user has chosen remains."""
    found = [m for m in obj.modifiers if m.type == "NODES" and m.node_group and m.node_group.name == NAME]
    modifier = found[0] if found else obj.modifiers.new(NAME, "NODES")
    if not found:
        modifier.node_group = group()
    sockets = {item.name: item.identifier for item in modifier.node_group.interface.items_tree if item.in_out == "INPUT"}
    if not found:
        modifier[sockets["Radius Factor"]] = 1.0
    if not found or ("Material" in sockets and materials.is_ours(modifier.get(sockets["Material"]))):
        modifier[sockets["Material"]] = material
