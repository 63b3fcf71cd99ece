//! Rotating and resizing. Places and sizes get few decimals.

use glam::{Quat, Vec3};
use splashdown::scene::{Domain, Emitter, MeshSource, Outlet, Scene, Shape};

use super::{Axis3, Item, decimal, decimals};

impl Item {
    /// The mesh of a thing that is one.
    pub fn mesh(self, scene: &Scene) -> Option<&MeshSource> {
        match self {
            Self::Body(index) => scene.bodies.get(index).map(|body| &body.mesh),
            Self::FluidMesh(index) => scene.fluid.meshes.get(index).map(|filled| &filled.mesh),
            Self::Block(_) | Self::Emitter(_) => None,
        }
    }

    fn mesh_mut(self, scene: &mut Scene) -> Option<&mut MeshSource> {
        match self {
            Self::Body(index) => scene.bodies.get_mut(index).map(|body| &mut body.mesh),
            Self::FluidMesh(index) => scene.fluid.meshes.get_mut(index).map(|filled| &mut filled.mesh),
            Self::Block(_) | Self::Emitter(_) => None,
        }
    }

    /// The emitter, if it is one.
    pub fn emitter(self, scene: &Scene) -> Option<&Emitter> {
        match self {
            Self::Emitter(index) => scene.emitters.get(index),
            Self::Block(_) | Self::FluidMesh(_) | Self::Body(_) => None,
        }
    }

    /// Whether it can be rotated.
    pub fn is_rotatable(self, scene: &Scene) -> bool {
        self.mesh(scene).is_some() || self.emitter(scene).is_some_and(has_direction)
    }

    /// Rotates a mesh about a point in m, or an emitter about its centre. Blocks, and emitters with the cross-section of a
    /// mesh, remain.
    pub fn rotate_by(self, scene: &mut Scene, rotation: Quat, about: Vec3) {
        if let Self::Emitter(index) = self
            && let Some(emitter) = scene.emitters.get_mut(index).filter(|emitter| has_direction(emitter))
        {
            emitter.direction = (rotation * emitter.direction).normalize_or(emitter.direction);
            return;
        }
        let spacing = scene.fluid.particle_spacing;
        let Some(mesh) = self.mesh_mut(scene) else { return };
        mesh.position = decimals(about + rotation * (mesh.position - about), spacing);
        mesh.rotation = (rotation * mesh.rotation).normalize();
    }

    /// Scales a mesh by a factor; a point in m stays where it is. Blocks and emitters have no scale.
    pub fn scale_by(self, scene: &mut Scene, factor: f32, about: Vec3) {
        let spacing = scene.fluid.particle_spacing;
        let Some(mesh) = self.mesh_mut(scene) else { return };
        mesh.position = decimals(about + factor * (mesh.position - about), spacing);
        mesh.scale = (factor * mesh.scale).map(|scale| decimal(scale, 0.01 * scale.abs()));
    }

    /// Moves a face of a block along its axis by an offset in m, inside the domain: that of the higher or the lower
    /// coordinate. A ball changes its radius.
    pub fn resize(self, scene: &mut Scene, axis: Axis3, is_upper: bool, offset: f32) {
        let (domain, least) = (scene.domain.clone(), scene.fluid.particle_spacing);
        let Self::Block(index) = self else { return };
        let Some(block) = scene.fluid.blocks.get_mut(index) else { return };
        match &mut block.shape {
            Shape::Box { min, size } => {
                let i = axis as usize;
                let (low, high) = (min[i], min[i] + size[i]);
                if is_upper {
                    // A face that is outside the domain already can stay where it is.
                    let high = (high + offset).clamp(low + least, domain.max[i].max(high).max(low + least));
                    size[i] = decimal(high - low, least);
                } else {
                    let low = (low + offset).clamp(domain.min[i].min(low).min(high - least), high - least);
                    min[i] = decimal(low, least);
                    size[i] = decimal(high - min[i], least);
                }
            }
            Shape::Sphere { center, radius } => {
                let outwards = if is_upper { offset } else { -offset };
                let largest = room(&domain, *center).max(*radius).max(least);
                *radius = decimal((*radius + outwards).clamp(least, largest), least);
            }
        }
    }
}

/// Whether the direction of an emitter can change on its own. That of a mesh is the normal of its cross-section.
fn has_direction(emitter: &Emitter) -> bool {
    !matches!(emitter.outlet, Outlet::Mesh(_))
}

/// The distance from a point to the nearest side of the domain.
fn room(domain: &Domain, point: Vec3) -> f32 {
    (point - domain.min).min(domain.max - point).min_element()
}

#[cfg(test)]
mod tests {
    use super::*;
    use splashdown::scene::{Block, presets};

    fn scene() -> Scene {
        let (name, text) = presets().iter().find(|(name, _)| *name == "dam-break-small").copied().unwrap();
        Scene::parse(text, name).unwrap()
    }

    #[test]
    fn a_mesh_turns_and_grows_about_a_point() {
        let mut scene = scene();
        crate::edit::add_ball(&mut scene);
        let (item, before) = (Item::Body(0), scene.bodies[0].mesh.clone());
        let about = before.position - Vec3::X;
        item.rotate_by(&mut scene, Quat::from_rotation_z(90_f32.to_radians()), about);
        let mesh = scene.bodies[0].mesh.clone();
        assert!((mesh.position - (about + Vec3::Y)).length() < 1e-6, "{mesh:?}");
        assert!((mesh.rotation * Vec3::X - Vec3::Y).length() < 1e-6);
        // A point of the mesh goes where a rotation about that point takes it.
        item.rotate_by(&mut scene, Quat::from_rotation_z(-90_f32.to_radians()), about);
        item.scale_by(&mut scene, 2.0, about);
        let mesh = &scene.bodies[0].mesh;
        assert!((mesh.position - (about + 2.0 * Vec3::X)).length() < 1e-6, "{mesh:?}");
        assert_eq!(mesh.scale, 2.0 * before.scale);
        let blocks = scene.fluid.blocks.clone();
        Item::Block(0).rotate_by(&mut scene, Quat::from_rotation_x(1.0), about);
        Item::Block(0).scale_by(&mut scene, 3.0, about);
        assert_eq!(scene.fluid.blocks, blocks);
    }

    #[test]
    fn an_emitter_turns_on_its_place() {
        let mut scene = scene();
        crate::edit::add_emitter(&mut scene);
        let (item, place) = (Item::Emitter(0), scene.emitters[0].position);
        assert!(item.is_rotatable(&scene) && !Item::Block(0).is_rotatable(&scene));
        item.rotate_by(&mut scene, Quat::from_rotation_z(90_f32.to_radians()), Vec3::ZERO);
        let emitter = &scene.emitters[0];
        assert!((emitter.direction - Vec3::X).length() < 1e-6, "{emitter:?}");
        assert_eq!(emitter.position, place);
    }

    #[test]
    fn moved_and_resized_things_have_few_decimals() {
        let mut scene = scene();
        let item = Item::Block(0);
        item.move_by(&mut scene, Vec3::new(0.1 + 0.26, 0.0, 0.0));
        item.move_by(&mut scene, Vec3::new(0.7 - 0.34 - 0.36, 0.0, 1e-7));
        item.resize(&mut scene, Axis3::Y, true, 0.1 - 0.24);
        let (low, high) = scene.fluid.blocks[0].shape.bounds();
        assert_eq!((low.x, low.z, high.y - low.y), (0.36, 0.0, 0.36), "{low} {high}");
        assert_eq!(high.y.to_string(), "0.36");
    }

    #[test]
    fn the_faces_of_a_block_stay_in_order_and_inside_the_domain() {
        let mut scene = scene();
        let (spacing, domain) = (scene.fluid.particle_spacing, scene.domain.clone());
        let (low, high) = (domain.min + 0.2 * domain.size(), domain.min + 0.5 * domain.size());
        let sides = [Axis3::X, Axis3::Y, Axis3::Z].into_iter().flat_map(|axis| [(axis, true), (axis, false)]);
        for (axis, is_upper) in sides {
            let i = axis as usize;
            let resized = |scene: &mut Scene, offset: f32| {
                let shape = Shape::Box { min: low, size: high - low };
                scene.fluid.blocks[0] = Block { shape, velocity: Vec3::ZERO };
                Item::Block(0).resize(scene, axis, is_upper, offset);
                let (low, high) = scene.fluid.blocks[0].shape.bounds();
                (low[i], high[i])
            };
            let (far, near) = if is_upper { (100.0, -100.0) } else { (-100.0, 100.0) };
            let close = |a: (f32, f32), b: (f32, f32)| (a.0 - b.0).abs().max((a.1 - b.1).abs()) < 1e-5;
            let moved = resized(&mut scene, 0.01);
            let (to_wall, thin) = (resized(&mut scene, far), resized(&mut scene, near));
            let expected = match is_upper {
                true => [(low[i], high[i] + 0.01), (low[i], domain.max[i]), (low[i], low[i] + spacing)],
                false => [(low[i] + 0.01, high[i]), (domain.min[i], high[i]), (high[i] - spacing, high[i])],
            };
            for (found, expected) in [moved, to_wall, thin].into_iter().zip(expected) {
                assert!(close(found, expected), "{axis:?} {is_upper}: {found:?}, not {expected:?}");
            }
        }
        let center = domain.center();
        scene.fluid.blocks[0].shape = Shape::Sphere { center, radius: 3.0 * spacing };
        Item::Block(0).resize(&mut scene, Axis3::Y, false, -spacing);
        assert_eq!(scene.fluid.blocks[0].shape, Shape::Sphere { center, radius: 4.0 * spacing });
        Item::Block(0).resize(&mut scene, Axis3::Y, true, 100.0);
        let (low, high) = scene.fluid.blocks[0].shape.bounds();
        assert!(low.cmpge(domain.min - 1e-6).all() && high.cmple(domain.max + 1e-6).all(), "{low} {high}");
    }
}
