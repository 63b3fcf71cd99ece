"""Materials of liquids and foam for Cycles and Eevee."""

import bpy

from .core.liquids import LIQUIDS

FOAM = "Splashdown Foam"
DROPLETS = " Droplets"


def _empty(name):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.node_tree.nodes.clear()
    if hasattr(material, "use_raytrace_refraction"):
        material.use_raytrace_refraction = True
    return material, material.node_tree.nodes, material.node_tree.links


def is_ours(material):
    """Whether a material is one of a liquid that this extension makes."""
    names = {f"Splashdown {known.label}{more}" for known in LIQUIDS.values() for more in ("", DROPLETS)}
    return material is not None and material.name in names


def liquid(name, metres_per_unit, with_volume=True):
    """The material of a liquid of [`LIQUIDS`]; it is made once and then belongs to the user.

    Glass with the refractive index of the liquid. The absorption follows the law of Beer and Lambert along the path
    within the mesh. Rays from matte surfaces to lights pass without refraction, because a path tracer hardly finds a
    small light through a refracting surface: the ground below the liquid would be black or noisy. These are shadow rays
    and diffuse rays; if only one kind passed, a light would count twice. `with_volume` is false for droplets, which are
    too small to absorb.
    """
    known = LIQUIDS.get(name, LIQUIDS["water"])
    full = f"Splashdown {known.label}" + ("" if with_volume else DROPLETS)
    if full in bpy.data.materials:
        return bpy.data.materials[full]
    material, nodes, links = _empty(full)
    output = nodes.new("ShaderNodeOutputMaterial")
    output.location = (400, 0)
    mix = nodes.new("ShaderNodeMixShader")
    mix.location = (200, 0)
    glass = nodes.new("ShaderNodeBsdfGlass")
    glass.location = (0, 0)
    glass.inputs["Roughness"].default_value = 0
    glass.inputs["IOR"].default_value = known.refractive_index
    clear = nodes.new("ShaderNodeBsdfTransparent")
    clear.location = (0, -200)
    # What a water surface lets pass at the usual angles.
    clear.inputs["Color"].default_value = (0.95, 0.95, 0.95, 1)
    passes = nodes.new("ShaderNodeMath")
    passes.operation = "MAXIMUM"
    passes.location = (0, 200)
    path = nodes.new("ShaderNodeLightPath")
    path.location = (-200, 300)
    links.new(path.outputs["Is Shadow Ray"], passes.inputs[0])
    links.new(path.outputs["Is Diffuse Ray"], passes.inputs[1])
    links.new(passes.outputs[0], mix.inputs[0])
    links.new(glass.outputs[0], mix.inputs[1])
    links.new(clear.outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], output.inputs["Surface"])
    if with_volume:
        volume = nodes.new("ShaderNodeVolumeAbsorption")
        volume.location = (200, -200)
        strongest = max(known.absorption)
        # Cycles absorbs density * (1 - colour) per unit of length.
        volume.inputs["Density"].default_value = strongest * metres_per_unit
        volume.inputs["Color"].default_value = (*(1 - part / strongest for part in known.absorption), 1)
        links.new(volume.outputs[0], output.inputs["Volume"])
    return material


def foam():
    """White, matte particles of foam, spray and bubbles."""
    if FOAM in bpy.data.materials:
        return bpy.data.materials[FOAM]
    material, nodes, links = _empty(FOAM)
    output = nodes.new("ShaderNodeOutputMaterial")
    output.location = (300, 0)
    matte = nodes.new("ShaderNodeBsdfDiffuse")
    matte.inputs["Color"].default_value = (0.9, 0.92, 0.93, 1)
    links.new(matte.outputs[0], output.inputs["Surface"])
    return material


def body(colour=None):
    """A matte material of a body of a run. `colour`: linear RGB in [0, 1]; grey without one."""
    red, green, blue = colour or (0.5, 0.5, 0.5)
    name = f"Splashdown Body {red:.3g} {green:.3g} {blue:.3g}" if colour else "Splashdown Body"
    if name in bpy.data.materials:
        return bpy.data.materials[name]
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.diffuse_color = (red, green, blue, 1)
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (red, green, blue, 1)
    shader.inputs["Roughness"].default_value = 0.6
    return material
