//! Materials: `UsdPreviewSurface` for every program, and MaterialX's `standard_surface` for renderers with refraction.

use super::layer::{Kind, Layer};
use super::value::Value;
use crate::stage::Material;

/// The shader's identifier, the name of its output, and the connection of the material.
const PREVIEW: [&str; 3] = ["UsdPreviewSurface", "outputs:surface", "outputs:surface"];
const STANDARD: [&str; 3] = ["ND_standard_surface_surfaceshader", "outputs:out", "outputs:mtlx:surface"];

/// A named input of a shader with its type.
type Input = (&'static str, &'static str, Value);

/// Adds a material at a path.
pub(super) fn add(layer: &mut Layer, path: &str, material: &Material) {
    let type_name = ("typeName", Value::token("Material"));
    layer.add(path, Kind::Prim, vec![("specifier", Value::DEF), type_name]);
    shader(layer, path, "preview", PREVIEW, preview(material));
    shader(layer, path, "standard", STANDARD, standard(material));
}

fn shader(
    layer: &mut Layer,
    material: &str,
    name: &str,
    [identifier, output, connected]: [&str; 3],
    inputs: Vec<Input>,
) {
    let path = format!("{material}/{name}");
    let target = format!("{path}.{output}");
    layer.add(
        &format!("{material}.{connected}"),
        Kind::Attribute,
        vec![("typeName", Value::token("token")), ("connectionPaths", Value::Targets(vec![target.clone()]))],
    );
    layer.add(&path, Kind::Prim, vec![("specifier", Value::DEF), ("typeName", Value::token("Shader"))]);
    layer.add(
        &format!("{path}.info:id"),
        Kind::Attribute,
        vec![
            ("typeName", Value::token("token")),
            ("variability", Value::UNIFORM),
            ("default", Value::token(identifier)),
        ],
    );
    for (name, kind, value) in inputs {
        layer.add(
            &format!("{path}.inputs:{name}"),
            Kind::Attribute,
            vec![("typeName", Value::token(kind)), ("default", value)],
        );
    }
    layer.add(&target, Kind::Attribute, vec![("typeName", Value::token("token"))]);
}

/// How opaque clear liquids and panes are shown without refraction, so that they can be seen.
const LIQUID_OPACITY: f32 = 0.35;
const PANE_OPACITY: f32 = 0.06;

fn preview(material: &Material) -> Vec<Input> {
    let (opacity, roughness, index) = match *material {
        Material::Liquid { refractive_index, .. } => {
            (1.0 - (1.0 - LIQUID_OPACITY) * material.clarity(), 0.02, refractive_index)
        }
        Material::Opaque { .. } => (1.0, 0.5, 1.5),
        Material::Panes => (PANE_OPACITY, 0.0, 1.0),
    };
    vec![
        ("diffuseColor", "color3f", Value::Float3(material.colour())),
        ("opacity", "float", Value::Float(opacity)),
        ("roughness", "float", Value::Float(roughness)),
        ("ior", "float", Value::Float(index)),
    ]
}

fn standard(material: &Material) -> Vec<Input> {
    let clear = material.clarity();
    let mut inputs = vec![
        ("base", "float", Value::Float(1.0 - clear)),
        ("base_color", "color3f", Value::Float3(material.colour())),
        ("transmission", "float", Value::Float(clear)),
    ];
    match *material {
        Material::Liquid { absorption, refractive_index, .. } => {
            let passed = absorption.map(|absorption| (-absorption).exp());
            inputs.extend([
                ("specular_roughness", "float", Value::Float(0.02)),
                ("specular_IOR", "float", Value::Float(refractive_index)),
                ("transmission_color", "color3f", Value::Float3(passed)),
                // The depth in m at which a white light has this colour.
                ("transmission_depth", "float", Value::Float(1.0)),
            ]);
        }
        Material::Opaque { .. } => inputs.push(("specular_roughness", "float", Value::Float(0.5))),
        Material::Panes => inputs.extend([
            ("specular_roughness", "float", Value::Float(0.0)),
            ("thin_walled", "bool", Value::Bool(true)),
        ]),
    }
    inputs
}
