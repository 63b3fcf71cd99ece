//! Scenes whose files are named but not opened.

use std::path::Path;

use crate::scene::{MeshShape, MeshSource, Outlet, Scene, SceneErrors, SinkRegion};

impl Scene {
    /// As [`parse_beside`](Self::parse_beside), without opening the files that the scene names, which may not exist any
    /// more: to draw the results of a finished run, only the meshes of its bodies are needed.
    ///
    /// # Errors
    /// As [`parse`](Self::parse).
    pub fn parse_unopened(text: &str, path: &Path) -> Result<Self, SceneErrors> {
        let mut scene = Self::parse(text, &path.display().to_string())?;
        scene.resolve_files(path.parent().unwrap_or(Path::new("")));
        Ok(Self { source: Some(path.to_owned()), ..scene })
    }

    /// Makes the names of files, which are as written in the text of the scene, relative to a folder.
    pub fn resolve_files(&mut self, folder: &Path) {
        let resolve = |mesh: &mut MeshSource| {
            if let MeshShape::File(path) = &mut mesh.shape {
                *path = folder.join(&path);
            }
        };
        self.bodies.iter_mut().for_each(|body| resolve(&mut body.mesh));
        self.fluid.meshes.iter_mut().for_each(|filled| resolve(&mut filled.mesh));
        for emitter in &mut self.emitters {
            if let Outlet::Mesh(mesh) = &mut emitter.outlet {
                resolve(mesh);
            }
        }
        for sink in &mut self.sinks {
            if let SinkRegion::Mesh(mesh) = &mut sink.region {
                resolve(mesh);
            }
        }
        for file in &mut self.fluid.files {
            file.path = folder.join(&file.path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "[scene]\nname = \"cube\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[fluid]\n\
        particle_spacing = 0.05\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.5, 0.5, 0.5]\n\
        [[body]]\nname = \"a\"\nmesh = \"gone/hull.stl\"\nposition = [0.5, 0.5, 0.5]\n\
        [[body]]\nname = \"b\"\nmesh = \"sphere\"\nscale = 0.2\nposition = [0.8, 0.8, 0.5]\n";

    #[test]
    fn files_that_do_not_exist_are_named_from_the_folder_of_the_scene() {
        let path = Path::new("/elsewhere/boat.toml");
        let scene = Scene::parse_unopened(SCENE, path).unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(scene.bodies[0].mesh.shape, MeshShape::File("/elsewhere/gone/hull.stl".into()));
        assert!(!matches!(scene.bodies[1].mesh.shape, MeshShape::File(_)));
        assert_eq!(scene.source.as_deref(), Some(path));
        // Control: a scene that is simulated needs its files.
        assert!(Scene::parse_beside(SCENE, path).is_err());
    }
}
