//! A scene with all of its frames as one binary file.
//!
//! The format has no meshes that change their triangles, so every frame of the fluid is a node of its own, which an animation
//! scales to zero at all other times. Bodies and the camera are nodes that move.

use std::io::{self, Write};

use serde_json::{Value, json};

use super::write::{ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER, FLOAT, POINTS, TRIANGLES, UNSIGNED_INT, write_file};
use crate::data::Mesh;
use crate::stage::{Blocks, Channel, Material, Object, Pose, Shape, Stage, Up, extent};

/// Largest size of the frames in bytes. The lengths in the file have 32 bits; the rest is for the description.
pub(crate) const LARGEST: u64 = u32::MAX as u64 - (256 << 20);

/// Writes a scene with its frames, which have at most [`LARGEST`] bytes.
pub(crate) fn write_stage(out: &mut dyn Write, stage: &Stage, blocks: &Blocks) -> io::Result<()> {
    let mut document = Document::new(stage, blocks);
    for (number, object) in stage.objects.iter().enumerate() {
        document.add(number, object, &object.name)?;
    }
    let bytes = blocks.bytes() as usize + document.more.len();
    let (json, more) = document.finish();
    write_file(out, &json, bytes, |out| {
        blocks.copy_to(out)?;
        out.write_all(&more)
    })
}

/// The description under construction.
struct Document<'a> {
    stage: &'a Stage,
    blocks: &'a Blocks,
    /// Data after the frames.
    more: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    cameras: Vec<Value>,
    nodes: Vec<Value>,
    samplers: Vec<Value>,
    channels: Vec<Value>,
    /// The accessor of the scales 0, 1, 0, which show a node for the second of three periods.
    shown: Option<usize>,
}

/// The shape of an array.
#[derive(Clone, Copy)]
struct Layout {
    kind: &'static str,
    component: u32,
    target: Option<u32>,
}

const SCALARS: Layout = Layout { kind: "SCALAR", component: FLOAT, target: None };
const VECTORS: Layout = Layout { kind: "VEC3", component: FLOAT, target: None };
const ROTATIONS: Layout = Layout { kind: "VEC4", component: FLOAT, target: None };
const AT_VERTICES: Layout = Layout { target: Some(ARRAY_BUFFER), ..VECTORS };
const CORNERS: Layout =
    Layout { kind: "SCALAR", component: UNSIGNED_INT, target: Some(ELEMENT_ARRAY_BUFFER) };

impl<'a> Document<'a> {
    fn new(stage: &'a Stage, blocks: &'a Blocks) -> Self {
        Self {
            stage,
            blocks,
            more: Vec::new(),
            views: Vec::new(),
            accessors: Vec::new(),
            meshes: Vec::new(),
            cameras: Vec::new(),
            nodes: Vec::new(),
            samplers: Vec::new(),
            channels: Vec::new(),
            shown: None,
        }
    }

    fn add(&mut self, number: usize, object: &Object, name: &str) -> io::Result<()> {
        match &object.shape {
            Shape::Surface | Shape::Points { .. } => self.add_frames(number, object, name),
            Shape::Solid(mesh) => {
                let mesh = self.solid(mesh, object, name);
                let node = self.node(name, object.pose, ("mesh", mesh));
                self.animate(node, number)
            }
            Shape::Camera { field_of_view, aspect, focus } => {
                self.cameras.push(json!({
                    "type": "perspective",
                    "perspective": {
                        "yfov": field_of_view.to_radians(),
                        "aspectRatio": aspect,
                        "znear": 0.001 * focus,
                        "zfar": 1000.0 * focus,
                    },
                }));
                let node = self.node(name, object.pose, ("camera", self.cameras.len() - 1));
                self.animate(node, number)
            }
        }
    }

    /// The number of an array at an offset of the buffer.
    fn accessor(&mut self, offset: u64, count: u64, bytes: u64, layout: Layout) -> usize {
        let mut view = json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes });
        if let Some(target) = layout.target {
            view["target"] = json!(target);
        }
        self.views.push(view);
        self.accessors.push(json!({
            "bufferView": self.views.len() - 1,
            "componentType": layout.component,
            "count": count,
            "type": layout.kind,
        }));
        self.accessors.len() - 1
    }

    /// The number of an array after the frames.
    fn store(&mut self, bytes: &[u8], count: usize, layout: Layout) -> usize {
        let offset = self.blocks.bytes() + self.more.len() as u64;
        self.more.extend_from_slice(bytes);
        self.accessor(offset, count as u64, bytes.len() as u64, layout)
    }

    fn set_bounds(&mut self, accessor: usize, low: impl serde::Serialize, high: impl serde::Serialize) {
        self.accessors[accessor]["min"] = json!(low);
        self.accessors[accessor]["max"] = json!(high);
    }

    fn node(&mut self, name: &str, pose: Pose, (what, number): (&str, usize)) -> usize {
        let mut node = json!({ "name": name, what: number });
        if pose != Pose::IDENTITY {
            node["translation"] = json!(pose.position);
            node["rotation"] = json!(pose.orientation);
        }
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    /// A node per frame of the fluid.
    fn add_frames(&mut self, number: usize, object: &Object, name: &str) -> io::Result<()> {
        let Some([first, last]) = self.blocks.frames() else { return Ok(()) };
        let blocks = self.blocks;
        for positions in blocks.of(number, Channel::Positions) {
            let frame = positions.frame;
            let mut attributes = serde_json::Map::new();
            for (name, channel) in [
                ("POSITION", Channel::Positions),
                ("NORMAL", Channel::Normals),
                // Names that are not part of the standard begin with an underscore.
                ("_VELOCITY", Channel::Velocities),
            ] {
                let Some(block) = blocks.at(number, channel, frame) else { continue };
                let accessor = self.accessor(block.elements(), block.count, block.bytes, AT_VERTICES);
                attributes.insert(name.to_owned(), json!(accessor));
                if let (Channel::Positions, Some(extent)) =
                    (channel, blocks.at(number, Channel::Extent, frame))
                {
                    let [a, b, c, d, e, f] = blocks.floats(extent)?;
                    self.set_bounds(accessor, [a, b, c], [d, e, f]);
                }
            }
            let mut primitive = json!({ "attributes": attributes });
            match object.shape {
                Shape::Surface => {
                    let Some(block) = blocks.at(number, Channel::Corners, frame) else { continue };
                    primitive["indices"] =
                        json!(self.accessor(block.elements(), block.count, block.bytes, CORNERS));
                    primitive["mode"] = json!(TRIANGLES);
                }
                _ => primitive["mode"] = json!(POINTS),
            }
            let own = format!("{name}_{frame:04}");
            let mesh = self.mesh(&own, object, primitive);
            let node = self.node(&own, object.pose, ("mesh", mesh));
            if frame != first {
                self.nodes[node]["scale"] = json!([0.0, 0.0, 0.0]);
            }
            if first != last {
                self.show_during(node, [first, frame, last]);
            }
        }
        Ok(())
    }

    fn mesh(&mut self, name: &str, object: &Object, mut primitive: Value) -> usize {
        if let Some(material) = object.material {
            primitive["material"] = json!(material);
        }
        let mut mesh = json!({ "name": name, "primitives": [primitive] });
        if let Shape::Points { diameter } = object.shape {
            mesh["extras"] = json!({ "diameter": diameter });
        }
        self.meshes.push(mesh);
        self.meshes.len() - 1
    }

    fn solid(&mut self, mesh: &Mesh, object: &Object, name: &str) -> usize {
        let positions = self.store(bytemuck::cast_slice(&mesh.vertices), mesh.vertices.len(), AT_VERTICES);
        let [low, high] = extent(&mesh.vertices);
        self.set_bounds(positions, low, high);
        let corners = self.store(bytemuck::cast_slice(&mesh.triangles), 3 * mesh.len(), CORNERS);
        let primitive =
            json!({ "attributes": { "POSITION": positions }, "indices": corners, "mode": TRIANGLES });
        self.mesh(name, object, primitive)
    }

    /// Shows a node during its frame only.
    fn show_during(&mut self, node: usize, [first, frame, last]: [u32; 3]) {
        let time = |frame: u32| self.time(frame, first);
        // A node is hidden from the first frame to its own, visible until the next, and hidden again.
        let (times, scales): (Vec<f32>, usize) = match frame {
            _ if frame == first => (vec![time(first), time(first + 1)], 1),
            _ if frame == last => (vec![time(first), time(frame)], 0),
            _ => (vec![time(first), time(frame), time(frame + 1)], 0),
        };
        let shown = match self.shown {
            Some(shown) => shown,
            None => {
                let scales: [[f32; 3]; 3] = [[0.0; 3], [1.0; 3], [0.0; 3]];
                let offset = self.store(bytemuck::cast_slice(&scales), 3, VECTORS);
                // The same scales from the second on, and without the last.
                let view = self.views.len() - 1;
                for (start, count) in [(12, 2), (0, 2)] {
                    let part = json!({
                        "bufferView": view, "byteOffset": start, "componentType": FLOAT, "count": count,
                        "type": "VEC3",
                    });
                    self.accessors.push(part);
                }
                *self.shown.insert(offset)
            }
        };
        let output = match (times.len(), scales) {
            (3, _) => shown,
            (_, 1) => shown + 1,
            _ => shown + 2,
        };
        let input = self.times(&times);
        self.channel(node, "scale", (input, output), "STEP");
    }

    /// The time of a frame in s after the first.
    fn time(&self, frame: u32, first: u32) -> f32 {
        (f64::from(frame - first) / self.stage.frames_per_second) as f32
    }

    /// The accessor of ascending times in s.
    fn times(&mut self, times: &[f32]) -> usize {
        let input = self.store(bytemuck::cast_slice(times), times.len(), SCALARS);
        self.set_bounds(input, [times.first()], [times.last()]);
        input
    }

    fn channel(&mut self, node: usize, path: &str, (input, output): (usize, usize), interpolation: &str) {
        let sampler = self.samplers.len();
        self.samplers.push(json!({ "input": input, "output": output, "interpolation": interpolation }));
        self.channels.push(json!({ "sampler": sampler, "target": { "node": node, "path": path } }));
    }

    /// Moves a node through the poses of its frames.
    fn animate(&mut self, node: usize, number: usize) -> io::Result<()> {
        let Some([first, _]) = self.blocks.frames() else { return Ok(()) };
        let (mut times, mut positions, mut orientations) = (Vec::new(), Vec::new(), Vec::<[f32; 4]>::new());
        for block in self.blocks.of(number, Channel::Pose) {
            let [x, y, z, i, j, k, w] = self.blocks.floats(block)?;
            times.push(self.time(block.frame, first));
            positions.push([x, y, z]);
            // Of the two quaternions of a rotation the one near the last, so that interpolation takes the short way.
            let own = [i, j, k, w];
            let is_opposite = orientations
                .last()
                .is_some_and(|last| last.iter().zip(own).map(|(a, b)| a * b).sum::<f32>() < 0.0);
            orientations.push(if is_opposite { own.map(|component| -component) } else { own });
        }
        if times.is_empty() {
            return Ok(());
        }
        let input = self.times(&times);
        let output = self.store(bytemuck::cast_slice(&positions), times.len(), VECTORS);
        self.channel(node, "translation", (input, output), "LINEAR");
        let output = self.store(bytemuck::cast_slice(&orientations), times.len(), ROTATIONS);
        self.channel(node, "rotation", (input, output), "LINEAR");
        Ok(())
    }

    /// The JSON, and the data after the frames.
    fn finish(mut self) -> (Value, Vec<u8>) {
        let mut root = json!({ "name": "splashdown" });
        match Up::of(self.stage.up) {
            Up::PlusY => {}
            Up::PlusZ => {
                let half = std::f32::consts::FRAC_1_SQRT_2;
                root["rotation"] = json!([-half, 0.0, 0.0, half]);
            }
            Up::Turned(rotation) => root["rotation"] = json!(rotation),
        }
        if !self.nodes.is_empty() {
            root["children"] = json!((0..self.nodes.len()).collect::<Vec<_>>());
        }
        self.nodes.push(root);
        let bytes = self.blocks.bytes() + self.more.len() as u64;
        let top = self.nodes.len() - 1;
        let mut document = json!({
            "asset": {
                "version": "2.0",
                "generator": "Splashdown",
                "extras": { "frames_per_second": self.stage.frames_per_second },
            },
            "extensionsUsed": ["KHR_materials_ior", "KHR_materials_transmission", "KHR_materials_volume"],
            "scene": 0,
            "scenes": [{ "nodes": [top] }],
            "buffers": [{ "byteLength": bytes }],
        });
        let materials = self.stage.materials.iter().map(|(name, material)| described(name, material));
        let animations = if self.channels.is_empty() {
            Vec::new()
        } else {
            let mut frames = json!({ "name": "frames" });
            frames["channels"] = Value::Array(self.channels);
            frames["samplers"] = Value::Array(self.samplers);
            vec![frames]
        };
        let lists = [
            ("nodes", self.nodes),
            ("materials", materials.collect()),
            ("meshes", self.meshes),
            ("cameras", self.cameras),
            ("accessors", self.accessors),
            ("bufferViews", self.views),
            ("animations", animations),
        ];
        // The format has no empty lists.
        for (name, list) in lists.into_iter().filter(|(_, list)| !list.is_empty()) {
            document[name] = Value::Array(list);
        }
        (document, self.more)
    }
}

/// A material in the format's terms.
pub(super) fn described(name: &str, material: &Material) -> Value {
    let (colour, clear) = (material.colour(), material.clarity());
    let [r, g, b] = colour;
    let look = |alpha: f32, roughness: f32| json!({ "baseColorFactor": [r, g, b, alpha], "metallicFactor": 0.0, "roughnessFactor": roughness });
    match *material {
        Material::Liquid { absorption, refractive_index, .. } => {
            // White, because the absorption colours what is seen through the liquid.
            let base = colour.map(|own| own + clear * (1.0 - own));
            let mut value = json!({
                "name": name,
                "pbrMetallicRoughness": look(1.0, 0.02),
                "extensions": {
                    "KHR_materials_ior": { "ior": refractive_index },
                    "KHR_materials_transmission": { "transmissionFactor": clear },
                    "KHR_materials_volume": {
                        "thicknessFactor": 0.1,
                        "attenuationDistance": 1.0,
                        "attenuationColor": absorption.map(|absorption| (-absorption).exp().max(1e-6)),
                    },
                },
            });
            value["pbrMetallicRoughness"]["baseColorFactor"] = json!([base[0], base[1], base[2], 1.0]);
            value
        }
        Material::Opaque { .. } => json!({ "name": name, "pbrMetallicRoughness": look(1.0, 0.5) }),
        Material::Panes => json!({
            "name": name,
            "pbrMetallicRoughness": look(0.06, 0.0),
            "alphaMode": "BLEND",
            "doubleSided": true,
        }),
    }
}
