"""Materials of the liquid and of the foam."""

import bpy

# Refractive index and absorption in 1/m of red, green and blue light.
OPTICS = {
    "water": (1.333, (0.35, 0.07, 0.02)),
    "oil": (1.467, (1.5, 3.0, 25.0)),
    "glycerin": (1.473, (0.4, 0.2, 0.2)),
    "honey": (1.49, (6.0, 25.0, 110.0)),
}


def liquid(name):
    """The material of a liquid: clear, with absorption in its volume."""
    index, absorption = OPTICS.get(name, OPTICS["water"])
    material = bpy.data.materials.get(f"Splashdown {name}")
    if material:
        return material
    material = bpy.data.materials.new(f"Splashdown {name}")
    if material.node_tree is None:
        material.use_nodes = True
    tree = material.node_tree
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    shader.inputs["Base Color"].default_value = (1, 1, 1, 1)
    shader.inputs["Roughness"].default_value = 0
    shader.inputs["IOR"].default_value = index
    shader.inputs["Transmission Weight"].default_value = 1
    volume = tree.nodes.new("ShaderNodeVolumeAbsorption")
    # Absorption is density * (1 - colour) per metre.
    strength = max(absorption)
    volume.inputs["Color"].default_value = (*(1 - value / strength for value in absorption), 1)
    volume.inputs["Density"].default_value = strength
    tree.links.new(volume.outputs["Volume"], output.inputs["Volume"])
    return material


def foam():
    """The white material of foam, spray and bubbles."""
    material = bpy.data.materials.get("Splashdown foam")
    if material:
        return material
    material = bpy.data.materials.new("Splashdown foam")
    if material.node_tree is None:
        material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = (0.9, 0.93, 0.95, 1)
    shader.inputs["Roughness"].default_value = 0.9
    return material
