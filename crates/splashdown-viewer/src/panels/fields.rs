//! The numbers of the selected thing in the tool Edit: position, size, rotation and scale, and the outflow of an emitter.

use std::ops::RangeInclusive;

use egui::{DragValue, Grid, Response, Ui};
use glam::{EulerRot, Quat, Vec3};
use splashdown::scene::{Emitter, Outlet, Scene, Shape};

use super::handles;
use crate::items::Item;
use crate::state::{State, Typing};

/// The largest coordinate in m.
const FAR: f32 = 1e4;

/// What has happened to the fields.
#[derive(Default)]
struct Changes {
    changed: bool,
    /// Whether a field is being dragged or typed into.
    is_active: bool,
}

impl Changes {
    fn add(&mut self, response: &Response) {
        self.changed |= response.changed();
        self.is_active |= response.dragged() || response.has_focus();
    }
}

/// Shows the fields. Returns the scene before a change that has ended: a number that was dragged or typed is one change.
pub(super) fn show(ui: &mut Ui, state: &mut State) -> Option<Scene> {
    let item = state.selected.filter(|item| item.is_movable(&state.scene));
    let mut changes = Changes::default();
    if let Some(item) = item {
        let before = state.scene.clone();
        let pivot = match &state.typing {
            Some(typing) => typing.pivot,
            None => handles::middle(item, state)
                .or_else(|| item.mesh(&state.scene).map(|mesh| mesh.position))
                .unwrap_or_default(),
        };
        Grid::new("fields").num_columns(4).spacing([4.0, 3.0]).show(ui, |ui| {
            position(ui, item, &mut state.scene, &mut changes);
            size(ui, item, &mut state.scene, &mut changes);
            outflow(ui, item, &mut state.scene, &mut changes);
            pose(ui, item, &mut state.scene, pivot, &mut changes);
        });
        if changes.changed && state.typing.is_none() {
            state.typing = Some(Typing { before, pivot });
        }
    }
    // Selecting another thing ends the change too.
    let ended = state.typing.take_if(|_| !changes.is_active)?;
    state.scene.emitters.iter_mut().for_each(normalise);
    Some(ended.before)
}

/// Gives a direction that was typed its unit length.
fn normalise(emitter: &mut Emitter) {
    if !emitter.direction.is_normalized() {
        emitter.direction = emitter.direction.normalize_or(Vec3::NEG_Y);
    }
}

/// A row of numbers.
fn row(
    ui: &mut Ui,
    name: &str,
    hint: &str,
    values: &mut [f32],
    (speed, range, decimals): (f32, RangeInclusive<f32>, usize),
    changes: &mut Changes,
) -> bool {
    let title = ui.label(name).on_hover_text(hint);
    let mut changed = false;
    for value in values {
        let field = DragValue::new(value)
            .range(range.clone())
            .clamp_existing_to_range(false)
            .speed(speed)
            .max_decimals(decimals);
        let response = ui.add(field).on_hover_text(hint).labelled_by(title.id);
        changed |= response.changed();
        changes.add(&response);
    }
    ui.end_row();
    changed
}

fn position(ui: &mut Ui, item: Item, scene: &mut Scene, changes: &mut Changes) {
    let place = match item {
        Item::Block(index) => scene.fluid.blocks.get(index).map(|block| match block.shape {
            Shape::Box { min, .. } => min,
            Shape::Sphere { center, .. } => center,
        }),
        Item::Emitter(index) => scene.emitters.get(index).map(|emitter| emitter.position),
        Item::Body(_) | Item::FluidMesh(_) => item.mesh(scene).map(|mesh| mesh.position),
    };
    let Some(place) = place else { return };
    let hint = "Lower corner of a box, centre of a ball or an outlet, or origin of a mesh, in m";
    let (mut values, speed) = (place.to_array(), 0.002 * scene.domain.size().max_element());
    if row(ui, "position", hint, &mut values, (speed, -FAR..=FAR, 4), changes) {
        item.move_by(scene, Vec3::from(values) - place);
    }
}

fn size(ui: &mut Ui, item: Item, scene: &mut Scene, changes: &mut Changes) {
    let (least, speed) = (scene.fluid.particle_spacing, 0.002 * scene.domain.size().max_element());
    let Item::Block(index) = item else { return };
    let Some(block) = scene.fluid.blocks.get_mut(index) else { return };
    match &mut block.shape {
        Shape::Box { size, .. } => {
            let mut values = size.to_array();
            if row(ui, "size", "Edges in m", &mut values, (speed, least..=FAR, 4), changes) {
                *size = Vec3::from(values);
            }
        }
        Shape::Sphere { radius, .. } => {
            let mut values = [*radius];
            if row(ui, "radius", "In m", &mut values, (speed, least..=FAR, 4), changes) {
                [*radius] = values;
            }
        }
    }
}

/// Outlet, direction and speed of an emitter.
fn outflow(ui: &mut Ui, item: Item, scene: &mut Scene, changes: &mut Changes) {
    let (least, speed) = (scene.fluid.particle_spacing, 0.002 * scene.domain.size().max_element());
    let Item::Emitter(index) = item else { return };
    let Some(emitter) = scene.emitters.get_mut(index) else { return };
    let lengths = (speed, least..=FAR, 4);
    match &mut emitter.outlet {
        Outlet::Disc { radius } => {
            row(ui, "radius", "Of the outlet, in m", std::slice::from_mut(radius), lengths, changes);
        }
        Outlet::Rectangle { size } => {
            let hint = "Edges of the outlet in m: horizontal, and perpendicular to it";
            row(ui, "size", hint, size, lengths, changes);
        }
        Outlet::Mesh(_) => {}
    }
    if item.is_rotatable(scene)
        && let Some(emitter) = scene.emitters.get_mut(index)
    {
        let mut values = emitter.direction.to_array();
        let hint = "Of the outflow: a vector, which gets the length 1";
        if row(ui, "direction", hint, &mut values, (0.01, -1.0..=1.0, 3), changes) {
            emitter.direction = Vec3::from(values);
        }
    }
    let Some(emitter) = scene.emitters.get_mut(index) else { return };
    let speeds = (0.01, 1e-3..=1e3, 3);
    row(ui, "speed", "Of the outflow, in m/s", std::slice::from_mut(&mut emitter.speed), speeds, changes);
}

/// Rotation and scale of a mesh, about a point in m.
fn pose(ui: &mut Ui, item: Item, scene: &mut Scene, pivot: Vec3, changes: &mut Changes) {
    let Some(mesh) = item.mesh(scene) else { return };
    let (z, y, x) = mesh.rotation.to_euler(EulerRot::ZYX);
    // Whole hundredths, because the angles of a rotation are rounded.
    let mut degrees = [x, y, z].map(|angle| (100.0 * angle.to_degrees()).round() / 100.0 + 0.0);
    let (rotation, scale) = (mesh.rotation, mesh.scale.x);
    let hint = "Degrees about x, then y, then z";
    if row(ui, "rotation", hint, &mut degrees, (1.0, -360.0..=360.0, 2), changes) {
        let [x, y, z] = degrees.map(f32::to_radians);
        let turn = Quat::from_euler(EulerRot::ZYX, z, y, x) * rotation.conjugate();
        item.rotate_by(scene, turn, pivot);
    }
    let mut values = [scale];
    let hint = "Metres per unit of the mesh; its proportions remain";
    if row(ui, "scale", hint, &mut values, (0.005 * scale, 1e-6..=1e6, 6), changes) && scale > 0.0 {
        item.scale_by(scene, values[0] / scale, pivot);
    }
}
