//! The things of a scene that can be selected, moved, rotated, resized and removed: blocks of fluid, meshes filled with
//! fluid, bodies and emitters at time 0.

mod decimal;
mod handle;
mod history;
mod pose;

use std::collections::BTreeMap;

use glam::Vec3;
use splashdown::scene::{Block, Motion, Outlet, Scene, Shape};

pub use decimal::{decimal, decimals};
pub use handle::{Axis3, Grab, along, angle, handle_at, line_distance};
pub use history::History;

/// One thing of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Item {
    /// A block of fluid, by its number in the scene.
    Block(usize),
    /// A mesh filled with fluid, by its number in the scene.
    FluidMesh(usize),
    /// A body, by its number in the scene.
    Body(usize),
    /// An emitter, by its number in the scene.
    Emitter(usize),
}

/// Bounding boxes of bodies by name, relative to the position of their mesh, in m. They need the meshes, which only the
/// engine has read.
pub type BodyBounds = BTreeMap<String, (Vec3, Vec3)>;

impl Item {
    /// All things of a scene.
    pub fn all(scene: &Scene) -> Vec<Self> {
        let blocks = (0..scene.fluid.blocks.len()).map(Self::Block);
        let meshes = (0..scene.fluid.meshes.len()).map(Self::FluidMesh);
        let bodies = (0..scene.bodies.len()).map(Self::Body);
        blocks.chain(meshes).chain(bodies).chain((0..scene.emitters.len()).map(Self::Emitter)).collect()
    }

    /// Whether the scene still has it.
    pub fn is_in(self, scene: &Scene) -> bool {
        match self {
            Self::Block(index) => index < scene.fluid.blocks.len(),
            Self::FluidMesh(index) => index < scene.fluid.meshes.len(),
            Self::Body(index) => index < scene.bodies.len(),
            Self::Emitter(index) => index < scene.emitters.len(),
        }
    }

    /// Its name for the user.
    pub fn name(self, scene: &Scene) -> String {
        match self {
            Self::Block(index) => format!("block {}", index + 1),
            Self::FluidMesh(index) => format!("fluid mesh {}", index + 1),
            Self::Body(index) => scene.bodies.get(index).map_or_else(String::new, |body| body.name.clone()),
            Self::Emitter(index) => {
                scene.emitters.get(index).map_or_else(String::new, |emitter| emitter.name.clone())
            }
        }
    }

    /// Whether it can be moved. A script determines the places of a scripted body.
    pub fn is_movable(self, scene: &Scene) -> bool {
        match self {
            Self::Body(index) => {
                scene.bodies.get(index).is_some_and(|body| !matches!(body.motion, Motion::Scripted(_)))
            }
            Self::Block(_) | Self::FluidMesh(_) | Self::Emitter(_) => self.is_in(scene),
        }
    }

    /// Its bounding box in m; `None` for a mesh that is not known: that of a body before the engine has read it, and those
    /// filled with fluid, which the engine does not keep.
    pub fn bounds(self, scene: &Scene, bodies: &BodyBounds) -> Option<(Vec3, Vec3)> {
        match self {
            Self::Block(index) => scene.fluid.blocks.get(index).map(|block| block.shape.bounds()),
            Self::FluidMesh(_) => None,
            Self::Body(index) => {
                let body = scene.bodies.get(index)?;
                let (low, high) = bodies.get(&body.name)?;
                Some((*low + body.mesh.position, *high + body.mesh.position))
            }
            Self::Emitter(index) => {
                let emitter = scene.emitters.get(index)?;
                let least = Vec3::splat(scene.fluid.particle_spacing);
                let half = match &emitter.outlet {
                    Outlet::Disc { radius } => *radius * across(emitter.direction),
                    Outlet::Rectangle { size } => Vec3::splat(0.5 * size[0].max(size[1])),
                    Outlet::Mesh(_) => 3.0 * least,
                };
                let half = half.max(least);
                Some((emitter.position - half, emitter.position + half))
            }
        }
    }

    /// Moves it by an offset in m, to coordinates with few decimals.
    pub fn move_by(self, scene: &mut Scene, offset: Vec3) {
        let spacing = scene.fluid.particle_spacing;
        let by = |place: &mut Vec3| {
            let moved = decimals(*place + offset, spacing);
            // A coordinate that is not moved keeps its decimals.
            *place = Vec3::select(offset.cmpeq(Vec3::ZERO), *place, moved);
        };
        match self {
            Self::Block(index) => {
                let block = scene.fluid.blocks.get_mut(index);
                match block.map(|block| &mut block.shape) {
                    Some(Shape::Box { min, .. }) => by(min),
                    Some(Shape::Sphere { center, .. }) => by(center),
                    None => {}
                }
            }
            Self::FluidMesh(index) => {
                if let Some(filled) = scene.fluid.meshes.get_mut(index) {
                    by(&mut filled.mesh.position);
                }
            }
            Self::Body(index) => {
                let Some(body) = scene.bodies.get_mut(index) else { return };
                by(&mut body.mesh.position);
                if let Motion::Dynamic { hinge: Some(hinge), .. } = &mut body.motion {
                    by(&mut hinge.point);
                }
            }
            Self::Emitter(index) => {
                let Some(emitter) = scene.emitters.get_mut(index) else { return };
                by(&mut emitter.position);
                if let Outlet::Mesh(mesh) = &mut emitter.outlet {
                    by(&mut mesh.position);
                }
            }
        }
    }

    /// Removes it.
    pub fn remove(self, scene: &mut Scene) {
        match self {
            _ if !self.is_in(scene) => {}
            Self::Block(index) => drop(scene.fluid.blocks.remove(index)),
            Self::FluidMesh(index) => drop(scene.fluid.meshes.remove(index)),
            Self::Body(index) => drop(scene.bodies.remove(index)),
            Self::Emitter(index) => drop(scene.emitters.remove(index)),
        }
    }
}

/// Half the extent of a disc of radius 1 along each axis, perpendicular to a unit vector.
fn across(direction: Vec3) -> Vec3 {
    (Vec3::ONE - direction * direction).max(Vec3::ZERO).map(f32::sqrt)
}

/// The thing that a ray (a point in m and a unit vector) enters first.
pub fn hit(scene: &Scene, bodies: &BodyBounds, ray: (Vec3, Vec3)) -> Option<Item> {
    let entered = |item: Item| Some((item, enters(item.bounds(scene, bodies)?, ray)?));
    let hits = Item::all(scene).into_iter().filter_map(entered);
    hits.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(item, _)| item)
}

/// The distance at which a ray enters a box.
fn enters((low, high): (Vec3, Vec3), (origin, direction): (Vec3, Vec3)) -> Option<f32> {
    let (a, b) = ((low - origin) / direction, (high - origin) / direction);
    let (near, far) = (a.min(b).max_element(), a.max(b).min_element());
    (near <= far && far > 0.0).then_some(near.max(0.0))
}

/// Adds a block of fluid in the upper middle of the domain, on whole spacings.
pub fn add_block(scene: &mut Scene) -> Item {
    let spacing = scene.fluid.particle_spacing;
    let whole = |v: Vec3| decimals(spacing * (v / spacing).round(), spacing);
    let size = whole(0.25 * scene.domain.size()).max(Vec3::splat(2.0 * spacing));
    let min = scene.domain.min + whole(Vec3::new(0.375, 0.6, 0.375) * scene.domain.size());
    let min = decimals(min, spacing);
    scene.fluid.blocks.push(Block { shape: Shape::Box { min, size }, velocity: Vec3::ZERO });
    Item::Block(scene.fluid.blocks.len() - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use splashdown::scene::presets;

    fn scene() -> Scene {
        let (name, text) = presets().iter().find(|(name, _)| *name == "double-dam-break").copied().unwrap();
        let mut scene = Scene::parse(text, name).unwrap();
        crate::edit::add_ball(&mut scene);
        crate::edit::add_emitter(&mut scene);
        scene
    }

    fn bounds() -> BodyBounds {
        [("ball-1".to_owned(), (Vec3::splat(-0.1), Vec3::splat(0.1)))].into()
    }

    #[test]
    fn things_are_moved_and_removed() {
        let mut scene = scene();
        let all = Item::all(&scene);
        assert_eq!(all, [Item::Block(0), Item::Block(1), Item::Body(0), Item::Emitter(0)]);
        for item in all {
            let before = item.bounds(&scene, &bounds()).unwrap();
            item.move_by(&mut scene, Vec3::new(0.0, 0.125, 0.0));
            let after = item.bounds(&scene, &bounds()).unwrap();
            assert!((after.0 - before.0 - Vec3::Y * 0.125).length() < 1e-6, "{item:?}");
        }
        Item::Block(0).remove(&mut scene);
        assert_eq!((scene.fluid.blocks.len(), Item::Block(1).is_in(&scene)), (1, false));
        Item::Block(7).remove(&mut scene);
        Item::Body(0).remove(&mut scene);
        Item::Emitter(0).remove(&mut scene);
        assert_eq!(Item::all(&scene), [Item::Block(0)]);
        assert_eq!(add_block(&mut scene), Item::Block(1));
        let text = crate::save::scene(&scene, &crate::camera::Orbit::of_scene(&scene)).unwrap();
        assert_eq!(Scene::parse(&text, "edited.toml").unwrap().fluid.blocks, scene.fluid.blocks);
    }

    #[test]
    fn a_ray_hits_the_nearest_thing() {
        let scene = scene();
        let from = Vec3::new(0.25, 0.4, 10.0);
        assert_eq!(hit(&scene, &bounds(), (from, Vec3::NEG_Z)), Some(Item::Block(0)));
        let from = Vec3::new(1.75, 0.4, 10.0);
        assert_eq!(hit(&scene, &bounds(), (from, Vec3::NEG_Z)), Some(Item::Block(1)));
        // From inside, and away from everything.
        assert_eq!(hit(&scene, &bounds(), (Vec3::new(1.75, 0.4, 0.75), Vec3::NEG_Z)), Some(Item::Block(1)));
        assert_eq!(hit(&scene, &bounds(), (from, Vec3::Z)), None);
        // A body without a known mesh cannot be hit.
        let ball = scene.bodies[0].mesh.position;
        let above = (ball + Vec3::Y * 5.0, Vec3::NEG_Y);
        assert_eq!(hit(&scene, &bounds(), above), Some(Item::Body(0)));
        assert_ne!(hit(&scene, &BodyBounds::new(), above), Some(Item::Body(0)));
    }
}
