//! The objects of a scene as prims.

use std::io;

use super::layer::{Kind, Layer};
use super::value::{Rep, Type, Value};
use super::{DATA, materials};
use crate::data::Mesh;
use crate::stage::{Blocks, Channel, Object, Pose, Shape, Stage, Up, extent, identifiers};

/// The path of the scene.
const ROOT: &str = "/splashdown";
/// The path of the materials, which no object has.
const MATERIALS: &str = "/splashdown/materials";
/// Height of the picture of a camera in tenths of a scene unit, that of a 35 mm film.
const APERTURE: f32 = 0.24;

/// Adds everything.
pub(super) fn add(layer: &mut Layer, stage: &Stage, blocks: &Blocks) -> io::Result<()> {
    let [first, last] = blocks.frames().unwrap_or_default();
    let rate = Value::Double(stage.frames_per_second);
    let up = Up::of(stage.up);
    layer.add(
        "/",
        Kind::Root,
        vec![
            ("defaultPrim", Value::token(&ROOT[1..])),
            ("documentation", Value::String("written by Splashdown; SI units".to_owned())),
            ("startTimeCode", Value::Double(first.into())),
            ("endTimeCode", Value::Double(last.into())),
            ("timeCodesPerSecond", rate.clone()),
            ("framesPerSecond", rate),
            ("metersPerUnit", Value::Double(1.0)),
            ("upAxis", Value::token(if up == Up::PlusZ { "Z" } else { "Y" })),
        ],
    );
    prim(layer, ROOT, "Xform", Vec::new());
    if let Up::Turned(orientation) = up {
        place(layer, ROOT, Pose { orientation, ..Pose::IDENTITY }, None);
    }
    let materials = material_paths(stage);
    // The first name is taken by the materials.
    let all = std::iter::once("materials").chain(stage.objects.iter().map(|object| object.name.as_str()));
    let names = identifiers(all).into_iter().skip(1);
    for (number, (object, name)) in stage.objects.iter().zip(names).enumerate() {
        let object = Added {
            layer: &mut *layer,
            blocks,
            object,
            number,
            path: format!("{ROOT}/{name}"),
            material: object.material.and_then(|material| materials.get(material)),
        };
        object.add(stage)?;
    }
    if !materials.is_empty() {
        prim(layer, MATERIALS, "Scope", Vec::new());
    }
    for (path, (_, material)) in materials.iter().zip(&stage.materials) {
        materials::add(layer, path, material);
    }
    Ok(())
}

fn material_paths(stage: &Stage) -> Vec<String> {
    let names = identifiers(stage.materials.iter().map(|(name, _)| name.as_str()));
    names.into_iter().map(|name| format!("{MATERIALS}/{name}")).collect()
}

fn prim(layer: &mut Layer, path: &str, kind: &str, fields: Vec<(&str, Value)>) {
    let first = vec![("specifier", Value::DEF), ("typeName", Value::token(kind))];
    layer.add(path, Kind::Prim, first.into_iter().chain(fields).collect());
}

fn attribute(layer: &mut Layer, path: &str, kind: &str, fields: Vec<(&str, Value)>) {
    let first = ("typeName", Value::token(kind));
    layer.add(path, Kind::Attribute, std::iter::once(first).chain(fields).collect());
}

/// An attribute that is constant in time by definition.
fn uniform(layer: &mut Layer, path: &str, kind: &str, value: Value) {
    attribute(layer, path, kind, vec![("variability", Value::UNIFORM), ("default", value)]);
}

/// The place of an object, which may change.
fn place(layer: &mut Layer, path: &str, pose: Pose, moves: Option<[Value; 2]>) {
    let Pose { position, orientation } = pose;
    let constant = [Value::Float3(position), Value::Quaternion(orientation)].map(|value| ("default", value));
    let fields = match moves {
        Some(samples) => samples.map(|value| ("timeSamples", value)),
        None => constant,
    };
    let operations = [("xformOp:translate", "float3"), ("xformOp:orient", "quatf")];
    for ((name, kind), field) in operations.into_iter().zip(fields) {
        attribute(layer, &format!("{path}.{name}"), kind, vec![field]);
    }
    let order = operations.iter().map(|(name, _)| (*name).to_owned()).collect();
    uniform(layer, &format!("{path}.xformOpOrder"), "token[]", Value::Tokens(order));
}

/// An object that is being added.
struct Added<'a> {
    layer: &'a mut Layer,
    blocks: &'a Blocks,
    object: &'a Object,
    number: usize,
    path: String,
    material: Option<&'a String>,
}

impl Added<'_> {
    fn add(mut self, stage: &Stage) -> io::Result<()> {
        let (kind, is_geometry) = match self.object.shape {
            Shape::Surface | Shape::Solid(_) => ("Mesh", true),
            Shape::Points { .. } => ("Points", true),
            Shape::Camera { .. } => ("Camera", false),
        };
        let bound = self.material.filter(|_| is_geometry).cloned();
        let binding = bound.iter().map(|_| ("apiSchemas", binding_schema())).collect();
        prim(self.layer, &self.path, kind, binding);
        if let Some(target) = bound {
            self.layer.add(
                &format!("{}.material:binding", self.path),
                Kind::Relationship,
                vec![("variability", Value::UNIFORM), ("targetPaths", Value::Targets(vec![target]))],
            );
            let colour = self.object.material.and_then(|number| stage.materials.get(number));
            let colour = colour.map_or([0.5; 3], |(_, material)| material.colour());
            self.constant("primvars:displayColor", "color3f[]", Value::Vectors(vec![colour]));
        }
        match &self.object.shape {
            Shape::Surface => self.surface()?,
            Shape::Solid(mesh) => self.solid(mesh),
            Shape::Points { diameter } => self.points(*diameter)?,
            Shape::Camera { field_of_view, aspect, focus } => {
                self.camera([*field_of_view, *focus], *aspect)?
            }
        }
        self.pose()
    }

    /// A value for the whole object.
    fn constant(&mut self, name: &str, kind: &str, value: Value) {
        let fields = vec![("interpolation", Value::token("constant")), ("default", value)];
        attribute(self.layer, &format!("{}.{name}", self.path), kind, fields);
    }

    /// An attribute with a value that is never animated, though it could be.
    fn set(&mut self, name: &str, kind: &str, value: Value) {
        attribute(self.layer, &format!("{}.{name}", self.path), kind, vec![("default", value)]);
    }

    /// The arrays of all frames as an attribute, unless no frame has any. Frames without one have an empty array.
    fn sampled(&mut self, name: &str, kind: &str, channel: Channel, element: Type) {
        let blocks = self.blocks.of(self.number, channel).iter();
        let values: Vec<(u32, u64)> = blocks.map(|block| (block.frame, block.offset)).collect();
        if values.is_empty() {
            return;
        }
        let samples = self.each_frame(&values, |_, offset| match offset {
            Some(offset) => Rep::array(element, DATA + offset),
            None => Rep::array(element, 0),
        });
        let mut fields = vec![("timeSamples", Value::Samples(samples))];
        if name.starts_with("primvars:") || name == "normals" {
            fields.push(("interpolation", Value::token("vertex")));
        }
        attribute(self.layer, &format!("{}.{name}", self.path), kind, fields);
    }

    /// A sample per frame, from values of some frames in ascending order.
    fn each_frame<T: Copy>(
        &mut self,
        values: &[(u32, T)],
        mut rep: impl FnMut(&mut Layer, Option<T>) -> Rep,
    ) -> Vec<(f64, Rep)> {
        let Some([first, last]) = self.blocks.frames() else { return Vec::new() };
        let mut values = values.iter().peekable();
        let frames = first..=last;
        frames
            .map(|frame| {
                let value = values.next_if(|(own, _)| *own == frame).map(|(_, value)| *value);
                (f64::from(frame), rep(self.layer, value))
            })
            .collect()
    }

    /// The bounding box in every frame, wider by a margin in m. That of nothing is turned inside out.
    fn extents(&mut self, margin: f32) -> io::Result<()> {
        let mut boxes = Vec::new();
        for block in self.blocks.of(self.number, Channel::Extent) {
            let [a, b, c, d, e, f] = self.blocks.floats(block)?;
            let low = [a, b, c].map(|bound| bound - margin);
            boxes.push((block.frame, [low, [d, e, f].map(|bound| bound + margin)]));
        }
        let samples = self.each_frame(&boxes, |layer, bounds| {
            layer.rep(Value::Vectors(bounds.unwrap_or([[f32::MAX; 3], [f32::MIN; 3]]).to_vec()))
        });
        let path = format!("{}.extent", self.path);
        attribute(self.layer, &path, "float3[]", vec![("timeSamples", Value::Samples(samples))]);
        Ok(())
    }

    fn surface(&mut self) -> io::Result<()> {
        self.mesh_kind();
        let blocks = self.blocks.of(self.number, Channel::Corners).iter();
        let corners: Vec<(u32, u64)> = blocks.map(|block| (block.frame, block.count)).collect();
        let counts = self.each_frame(&corners, |layer, corners| {
            layer.rep(Value::Threes(corners.unwrap_or(0) as usize / 3))
        });
        let path = format!("{}.faceVertexCounts", self.path);
        attribute(self.layer, &path, "int[]", vec![("timeSamples", Value::Samples(counts))]);
        self.extents(0.0)?;
        self.sampled("faceVertexIndices", "int[]", Channel::Corners, Type::Int);
        self.sampled("points", "point3f[]", Channel::Positions, Type::Vec3f);
        self.sampled("normals", "normal3f[]", Channel::Normals, Type::Vec3f);
        self.sampled("velocities", "vector3f[]", Channel::Velocities, Type::Vec3f);
        Ok(())
    }

    fn mesh_kind(&mut self) {
        for (name, word) in [("subdivisionScheme", "none"), ("orientation", "rightHanded")] {
            uniform(self.layer, &format!("{}.{name}", self.path), "token", Value::token(word));
        }
    }

    fn solid(&mut self, mesh: &Mesh) {
        self.mesh_kind();
        let corners = mesh.triangles.as_flattened().iter().map(|&vertex| vertex as i32).collect();
        self.set("extent", "float3[]", Value::Vectors(extent(&mesh.vertices).to_vec()));
        self.set("faceVertexCounts", "int[]", Value::Threes(mesh.len()));
        self.set("faceVertexIndices", "int[]", Value::Integers(corners));
        self.set("points", "point3f[]", Value::Vectors(mesh.vertices.clone()));
        if self.material_is_thin() {
            self.set("doubleSided", "bool", Value::Bool(true));
        }
    }

    /// Open meshes are seen from both sides.
    fn material_is_thin(&self) -> bool {
        matches!(&self.object.shape, Shape::Solid(mesh) if mesh.topology().is_ok_and(|mesh| !mesh.is_watertight()))
    }

    fn points(&mut self, diameter: f32) -> io::Result<()> {
        self.constant("widths", "float[]", Value::Floats(vec![diameter]));
        self.extents(0.5 * diameter)?;
        self.sampled("points", "point3f[]", Channel::Positions, Type::Vec3f);
        self.sampled("velocities", "vector3f[]", Channel::Velocities, Type::Vec3f);
        self.sampled("ids", "int64[]", Channel::Ids, Type::Int64);
        self.sampled("primvars:density", "float[]", Channel::Densities, Type::Float);
        self.sampled("primvars:pressure", "float[]", Channel::Pressures, Type::Float);
        Ok(())
    }

    /// The focal length and the film are in tenths of a scene unit.
    fn camera(&mut self, lens: [f32; 2], aspect: f32) -> io::Result<()> {
        let mut lenses = Vec::new();
        for block in self.blocks.of(self.number, Channel::Lens) {
            lenses.push((block.frame, self.blocks.floats(block)?));
        }
        type Part = fn([f32; 2]) -> f32;
        let parts: [(&str, Part); 2] = [("focalLength", focal_length), ("focusDistance", |[_, focus]| focus)];
        for (name, part) in parts {
            if lenses.iter().all(|(_, other)| *other == lens) {
                self.set(name, "float", Value::Float(part(lens)));
                continue;
            }
            let samples = self.each_frame(&lenses, |layer, own: Option<[f32; 2]>| {
                layer.rep(Value::Float(part(own.unwrap_or(lens))))
            });
            let path = format!("{}.{name}", self.path);
            attribute(self.layer, &path, "float", vec![("timeSamples", Value::Samples(samples))]);
        }
        let [_, focus] = lens;
        self.set("verticalAperture", "float", Value::Float(APERTURE));
        self.set("horizontalAperture", "float", Value::Float(APERTURE * aspect));
        self.set("clippingRange", "float2", Value::Float2([0.001 * focus, 1000.0 * focus]));
        Ok(())
    }

    /// The place of the object, in every frame if it moves.
    fn pose(mut self) -> io::Result<()> {
        let mut poses = Vec::new();
        for block in self.blocks.of(self.number, Channel::Pose) {
            let [x, y, z, i, j, k, w] = self.blocks.floats(block)?;
            poses.push((block.frame, Pose { position: [x, y, z], orientation: [i, j, k, w] }));
        }
        let own = self.object.pose;
        if poses.is_empty() {
            if own != Pose::IDENTITY {
                place(self.layer, &self.path, own, None);
            }
            return Ok(());
        }
        let positions =
            self.each_frame(&poses, |layer, pose| layer.rep(Value::Float3(pose.unwrap_or(own).position)));
        let orientations = self
            .each_frame(&poses, |layer, pose| layer.rep(Value::Quaternion(pose.unwrap_or(own).orientation)));
        place(self.layer, &self.path, own, Some([positions, orientations].map(Value::Samples)));
        Ok(())
    }
}

fn binding_schema() -> Value {
    Value::Prepended(vec!["MaterialBindingAPI".to_owned()])
}

/// The focal length for an angle of view.
fn focal_length([field_of_view, _]: [f32; 2]) -> f32 {
    0.5 * APERTURE / (0.5 * field_of_view.to_radians()).tan()
}
