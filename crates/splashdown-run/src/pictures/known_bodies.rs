//! The meshes of the bodies of a finished run.

use splashdown::BodyMesh;
use splashdown::bodies::body_meshes;

use crate::RunFrames;

/// The meshes of the bodies of a run whose places are known.
pub struct KnownBodies {
    /// Those that can be read.
    pub meshes: Vec<BodyMesh>,
    /// Which of the bodies with a known place have one.
    pub has_mesh: Vec<bool>,
    /// Why others have none.
    pub problems: Vec<String>,
}

impl KnownBodies {
    /// Reads the meshes of the bodies whose places are known. One that cannot be read is a problem.
    pub fn of(frames: &RunFrames) -> Self {
        let mut bodies = Self { meshes: Vec::new(), has_mesh: Vec::new(), problems: Vec::new() };
        for name in frames.body_names() {
            let mut scene = frames.scene().clone();
            scene.bodies.retain(|body| body.name == name);
            match body_meshes(&scene) {
                Ok(mut mesh) => {
                    bodies.has_mesh.push(!mesh.is_empty());
                    bodies.meshes.append(&mut mesh);
                }
                Err(error) => {
                    bodies.has_mesh.push(false);
                    bodies.problems.push(format!("the body {name:?} is not shown: {error}"));
                }
            }
        }
        bodies
    }
}
