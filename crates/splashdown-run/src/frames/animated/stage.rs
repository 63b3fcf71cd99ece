//! What the animated files of a scene contain.

use std::sync::Arc;

use splashdown::foam::DiffuseKind;
use splashdown::glam::{Mat3, Quat, Vec3};
use splashdown::run::Frame;
use splashdown::scene::{Scene, TankKind};
use splashdown::surface::droplet_radius;
use splashdown::{BodyMesh, BodyState};
use splashdown_io::stage::{Material, Object, Pose, Sample, Shape, Stage};
use splashdown_io::{Mesh, Particles};
use splashdown_render::{Camera, PlacedBody};

use crate::appearance;
use crate::folder::DROPLETS;

/// A frame to add.
pub struct Content<'a> {
    pub frame: &'a Frame,
    /// Its droplets and diffuse particles, by name.
    pub points: &'a [(&'static str, Arc<Particles>)],
}

/// The objects of a file, and where their data comes from.
#[derive(Debug)]
pub struct Layout {
    pub stage: Stage,
    sources: Vec<Source>,
    scene: Arc<Scene>,
}

/// Where the data of an object comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Source {
    Surface,
    Particles,
    /// The points of this name.
    Points(&'static str),
    /// The body of this number.
    Body(usize),
    Camera,
    /// It does not change.
    Constant,
}

/// The numbers of the materials in a stage.
const LIQUID: usize = 0;
const FOAM: usize = 1;
const PANES: usize = 2;

impl Layout {
    /// The scene: the surface with droplets, foam and spray, the bodies, the tank and the camera. Without a surface, the
    /// particles.
    pub fn scene(scene: &Scene, bodies: &[BodyMesh]) -> Option<Self> {
        let mut layout = Self::empty(scene);
        let spacing = scene.fluid.particle_spacing;
        if scene.surface.enabled {
            layout.add("surface", Shape::Surface, Some(LIQUID), Source::Surface);
        } else {
            layout.add("particles", Shape::Points { diameter: spacing }, Some(LIQUID), Source::Particles);
        }
        if scene.surface.separates() {
            let shape = Shape::Points { diameter: 2.0 * droplet_radius(spacing) };
            layout.add(DROPLETS, shape, Some(LIQUID), Source::Points(DROPLETS));
        }
        if scene.foam.enabled {
            for (kind, name) in DiffuseKind::ALL {
                let shape = Shape::Points { diameter: diffuse_diameter(kind, spacing) };
                layout.add(name, shape, Some(FOAM), Source::Points(name));
            }
        }
        if scene.picture.tank != TankKind::None
            && let Some(tank) = tank(scene)
        {
            layout.add("tank", Shape::Solid(Arc::new(tank)), Some(PANES), Source::Constant);
        }
        layout.add_camera();
        // Last, so that a body of one of these names gets another one.
        for (number, body) in bodies.iter().enumerate() {
            layout.add_body(number, body);
        }
        Some(layout)
    }

    /// The particles, if the [scene](Self::scene) does not contain them.
    pub fn particles(scene: &Scene) -> Option<Self> {
        let mut layout = Self::empty(scene);
        let diameter = scene.fluid.particle_spacing;
        layout.add("particles", Shape::Points { diameter }, Some(LIQUID), Source::Particles);
        scene.surface.enabled.then_some(layout)
    }

    fn empty(scene: &Scene) -> Self {
        let liquid = appearance::liquid(scene);
        let liquid = Material::Liquid {
            absorption: liquid.absorption,
            scattering: liquid.scattering,
            colour: liquid.colour,
            refractive_index: liquid.refractive_index,
        };
        let foam = Material::Opaque { colour: FOAM_COLOUR };
        let materials = [("liquid", liquid), ("foam", foam), ("panes", Material::Panes)];
        let stage = Stage {
            frames_per_second: scene.frame_rate.into(),
            up: (-scene.gravity).into(),
            objects: Vec::new(),
            materials: materials.map(|(name, material)| (name.to_owned(), material)).to_vec(),
        };
        Self { stage, sources: Vec::new(), scene: Arc::new(scene.clone()) }
    }

    fn add(&mut self, name: &str, shape: Shape, material: Option<usize>, source: Source) {
        self.stage.objects.push(Object { name: name.to_owned(), shape, pose: Pose::IDENTITY, material });
        self.sources.push(source);
    }

    fn add_body(&mut self, number: usize, body: &BodyMesh) {
        let colour = body.colour.unwrap_or(PlacedBody::COLOUR);
        let material = self.stage.materials.len();
        self.stage.materials.push((body.name.clone(), Material::Opaque { colour }));
        self.add(&body.name, Shape::Solid(Arc::clone(&body.mesh)), Some(material), Source::Body(number));
    }

    fn add_camera(&mut self) {
        let camera = appearance::camera(&self.scene, 0.0);
        let [width, height] = self.scene.output.picture_size.map(|side| side as f32);
        let shape = Shape::Camera {
            field_of_view: camera.field_of_view_deg,
            aspect: width / height,
            focus: distance(&camera),
        };
        self.add("camera", shape, None, Source::Camera);
    }

    /// The data of a frame, with the numbers of the objects.
    pub fn samples(&self, content: &Content<'_>) -> Vec<(usize, Sample)> {
        let Content { frame, points } = content;
        let sample = |source: &Source| match source {
            Source::Surface => frame.mesh.as_ref().map(|mesh| Sample::Mesh(Arc::clone(mesh))),
            Source::Particles => Some(Sample::Points(Arc::clone(&frame.particles))),
            Source::Points(name) => {
                let (_, particles) = points.iter().find(|(other, _)| other == name)?;
                Some(Sample::Points(Arc::clone(particles)))
            }
            Source::Body(number) => frame.bodies.get(*number).map(|state| Sample::Pose(pose_of(state))),
            Source::Camera => {
                let camera = appearance::camera(&self.scene, frame.time);
                let field_of_view = camera.field_of_view_deg;
                Some(Sample::View { pose: view(&camera), field_of_view, focus: distance(&camera) })
            }
            Source::Constant => None,
        };
        let samples = self.sources.iter().enumerate();
        samples.filter_map(|(number, source)| Some((number, sample(source)?))).collect()
    }
}

/// White with a trace of the water's blue, as in pictures.
const FOAM_COLOUR: [f32; 3] = [0.9, 0.93, 0.95];

/// Diameter of diffuse particles in m, as in pictures.
fn diffuse_diameter(kind: DiffuseKind, spacing: f32) -> f32 {
    spacing
        * match kind {
            DiffuseKind::Spray => 0.26,
            DiffuseKind::Foam => 0.5,
            DiffuseKind::Bubble => 0.32,
        }
}

fn pose_of(state: &BodyState) -> Pose {
    Pose { position: state.position.into(), orientation: state.orientation.into() }
}

fn distance(camera: &Camera) -> f32 {
    let squares = camera.eye.iter().zip(camera.target).map(|(a, b)| (a - b).powi(2));
    squares.sum::<f32>().sqrt()
}

/// The place of a camera that looks along -z with +y up.
fn view(camera: &Camera) -> Pose {
    let [eye, target, up] = [camera.eye, camera.target, camera.up].map(Vec3::from);
    let back = (eye - target).normalize_or_zero();
    let right = up.cross(back).normalize_or_zero();
    let rotation = Quat::from_mat3(&Mat3::from_cols(right, back.cross(right), back));
    Pose { position: camera.eye, orientation: rotation.into() }
}

/// The closed sides of the domain as panes without thickness, which face inwards. `None` if all sides are open.
fn tank(scene: &Scene) -> Option<Mesh> {
    let (low, high) = (scene.domain.min, scene.domain.max);
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (axis, sides) in scene.domain.closed.iter().enumerate() {
        for (side, _) in sides.iter().enumerate().filter(|(_, closed)| **closed) {
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            let first = vertices.len() as u32;
            for [at_u, at_v] in [[low[u], low[v]], [high[u], low[v]], [high[u], high[v]], [low[u], high[v]]] {
                let mut vertex = [0.0; 3];
                vertex[axis] = if side == 0 { low[axis] } else { high[axis] };
                (vertex[u], vertex[v]) = (at_u, at_v);
                vertices.push(vertex);
            }
            let corners = if side == 0 { [[0, 1, 2], [0, 2, 3]] } else { [[0, 2, 1], [0, 3, 2]] };
            triangles.extend(corners.map(|triangle: [u32; 3]| triangle.map(|corner| first + corner)));
        }
    }
    (!triangles.is_empty()).then(|| Mesh::new(vertices, triangles))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(more: &str) -> Scene {
        let text = format!(
            "[scene]\nname = \"test\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [1, 2, 3]\nopen = [\"y_max\"]\n{more}\n[fluid]\nparticle_spacing = 0.1\n\
             [[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.5, 0.5, 0.5]\n"
        );
        Scene::parse(&text, "test").unwrap_or_else(|errors| panic!("{errors}"))
    }

    #[test]
    fn the_camera_looks_at_its_target() {
        let camera = Camera::orbit([0.5, 0.2, 0.1], 3.0, 30.0, 20.0, 40.0);
        let Pose { position, orientation } = view(&camera);
        let rotation = Quat::from_array(orientation);
        let ahead = Vec3::from(position) + rotation * Vec3::new(0.0, 0.0, -3.0);
        assert!((ahead - Vec3::new(0.5, 0.2, 0.1)).length() < 1e-5, "{ahead}");
        assert!((rotation * Vec3::Y).y > 0.9, "up is up");
    }

    #[test]
    fn the_tank_has_the_closed_sides_facing_inwards() {
        let mesh = tank(&scene("")).unwrap();
        assert_eq!(mesh.len(), 10);
        let centre = Vec3::new(0.5, 1.0, 1.5);
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|corner| Vec3::from(mesh.vertices[corner as usize]));
            assert!((b - a).cross(c - a).dot(centre - a) > 0.0, "{triangle:?} faces outwards");
        }
    }

    #[test]
    fn objects_and_their_data_have_the_same_order() {
        let scene = scene("[foam]\nenabled = true\n[surface]\nenabled = true");
        let layout = Layout::scene(&scene, &[]).unwrap();
        let names: Vec<&str> = layout.stage.objects.iter().map(|object| object.name.as_str()).collect();
        assert_eq!(names, ["surface", "droplets", "spray", "foam", "bubbles", "tank", "camera"]);
        assert_eq!(layout.sources.len(), names.len());
        assert_eq!(layout.stage.up, [-0.0, 9.81, -0.0]);
        assert!(Layout::particles(&scene).is_some());
    }
}
