//! Blocks of fluid, bodies and emitters of a changed scene.

use glam::{Quat, Vec3};
use splashdown::scene::{
    Block, Body, Emitter, FluidMesh, MeshShape, MeshSource, Motion, Outlet, Scene, Shape,
};
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, TableLike, value};

use super::values::{degrees, direction, number, pair, vector};

/// Writes moved, removed and added blocks.
pub fn blocks(document: &mut DocumentMut, old: &[Block], new: &[Block]) {
    if old == new {
        return;
    }
    let fluid = document.entry("fluid").or_insert(Item::Table(Table::new()));
    let Some(list) = fluid.as_table_like_mut().and_then(|fluid| tables(fluid, "block")) else { return };
    let mut kept: Vec<&Block> = old.iter().collect();
    // Of more blocks than there are now, those that no longer exist as they were are removed, the last ones first.
    while kept.len() > new.len() {
        let gone = kept.iter().rposition(|block| !new.contains(block)).unwrap_or(kept.len() - 1);
        kept.remove(gone);
        list.remove(gone);
    }
    for (index, block) in new.iter().enumerate() {
        match kept.get(index) {
            Some(before) if *before == block => {}
            Some(_) => {
                if let Some(table) = list.get_mut(index) {
                    write_block(table, block);
                }
            }
            None => {
                let mut table = Table::new();
                write_block(&mut table, block);
                list.push(table);
            }
        }
    }
}

fn write_block(table: &mut Table, block: &Block) {
    match block.shape {
        Shape::Box { min, size } => {
            for key in ["shape", "center", "radius"] {
                table.remove(key);
            }
            table.insert("position", vector(min));
            table.insert("size", vector(size));
        }
        Shape::Sphere { center, radius } => {
            for key in ["position", "size"] {
                table.remove(key);
            }
            table.insert("shape", value("sphere"));
            table.insert("center", vector(center));
            table.insert("radius", number(radius));
        }
    }
    if block.velocity != Vec3::ZERO || table.contains_key("velocity") {
        table.insert("velocity", vector(block.velocity));
    }
}

/// Writes moved, removed and added meshes that are filled with fluid.
///
/// # Errors
/// A message, if a scene file cannot express an added one.
pub fn fluid_meshes(document: &mut DocumentMut, old: &[FluidMesh], new: &[FluidMesh]) -> Result<(), String> {
    if old == new {
        return Ok(());
    }
    let fluid = document.entry("fluid").or_insert(Item::Table(Table::new()));
    let fluid = fluid.as_table_like_mut().ok_or("`fluid` is not a table")?;
    let is_same = |before: &FluidMesh, now: &FluidMesh| {
        let mut before = before.clone();
        adopt_pose(&mut before.mesh, &now.mesh);
        before == *now
    };
    let moved = |table: &mut Table, before: &FluidMesh, now: &FluidMesh| pose(table, &before.mesh, &now.mesh);
    differences(tables(fluid, "mesh"), (old, new), is_same, moved, |filled| mesh_table(&filled.mesh))
}

/// Writes moved, rotated, resized, removed and added bodies.
///
/// # Errors
/// A message, if a scene file cannot express an added body.
pub fn bodies(document: &mut DocumentMut, old: &[Body], new: &[Body]) -> Result<(), String> {
    let is_same = |before: &Body, now: &Body| {
        let mut before = before.clone();
        adopt_pose(&mut before.mesh, &now.mesh);
        let hinges = (&mut before.motion, &now.motion);
        if let (Motion::Dynamic { hinge: Some(before), .. }, Motion::Dynamic { hinge: Some(now), .. }) =
            hinges
        {
            before.point = now.point;
        }
        before == *now
    };
    let moved = |table: &mut Table, before: &Body, now: &Body| {
        pose(table, &before.mesh, &now.mesh);
        if let (true, Motion::Dynamic { hinge: Some(hinge), .. }) =
            (table.contains_key("hinge_point"), &now.motion)
        {
            table.insert("hinge_point", vector(hinge.point));
        }
    };
    if old == new {
        return Ok(());
    }
    differences(tables(document.as_table_mut(), "body"), (old, new), is_same, moved, body_table)
}

/// Writes moved, removed and added emitters.
///
/// # Errors
/// A message, if a scene file cannot express an added emitter.
pub fn emitters(document: &mut DocumentMut, old: &[Emitter], new: &[Emitter]) -> Result<(), String> {
    let is_same = |before: &Emitter, now: &Emitter| {
        let mut before = before.clone();
        (before.position, before.direction, before.speed) = (now.position, now.direction, now.speed);
        match (&mut before.outlet, &now.outlet) {
            (Outlet::Disc { radius: before }, Outlet::Disc { radius: now }) => *before = *now,
            (Outlet::Rectangle { size: before }, Outlet::Rectangle { size: now }) => *before = *now,
            (Outlet::Mesh(before), Outlet::Mesh(now)) => before.position = now.position,
            _ => {}
        }
        before == *now
    };
    if old == new {
        return Ok(());
    }
    differences(tables(document.as_table_mut(), "emitter"), (old, new), is_same, write_emitter, emitter_table)
}

/// Writes what the window can change of an emitter, as far as it has changed.
fn write_emitter(table: &mut Table, before: &Emitter, now: &Emitter) {
    if before.position != now.position {
        table.insert("position", vector(now.position));
    }
    if before.direction != now.direction {
        table.insert("direction", direction(now.direction));
    }
    if before.speed != now.speed {
        table.insert("speed", number(now.speed));
    }
    match &now.outlet {
        outlet if *outlet == before.outlet => {}
        Outlet::Disc { radius } => drop(table.insert("radius", number(*radius))),
        Outlet::Rectangle { size } => drop(table.insert("size", pair(*size))),
        Outlet::Mesh(_) => {}
    }
}

/// Writes the differences of a list. `is_same` tells whether a thing has only been moved. The name does not: a removed thing
/// may have left its name to another one.
fn differences<T: PartialEq>(
    list: Option<&mut ArrayOfTables>,
    (old, new): (&[T], &[T]),
    is_same: impl Fn(&T, &T) -> bool,
    moved: impl Fn(&mut Table, &T, &T),
    table: impl Fn(&T) -> Result<Table, String>,
) -> Result<(), String> {
    let list = list.ok_or("a section of the scene file is not a list of tables")?;
    // What remains keeps its order, and what is added comes after it.
    let (mut kept, mut added, mut next) = (vec![None; old.len()], Vec::new(), 0);
    for thing in new {
        match (next..old.len()).find(|&index| is_same(&old[index], thing)) {
            Some(index) => {
                kept[index] = Some(thing);
                next = index + 1;
            }
            None => added.push(thing),
        }
    }
    for (index, (before, now)) in old.iter().zip(kept).enumerate().rev() {
        match now {
            None => drop(list.remove(index)),
            Some(now) if now == before => {}
            Some(now) => {
                if let Some(table) = list.get_mut(index) {
                    moved(table, before, now);
                }
            }
        }
    }
    for thing in added {
        list.push(table(thing)?);
    }
    Ok(())
}

/// Gives a mesh the position, the rotation and the scale of another one.
fn adopt_pose(mesh: &mut MeshSource, other: &MeshSource) {
    (mesh.position, mesh.rotation, mesh.scale) = (other.position, other.rotation, other.scale);
}

/// Writes the position, the rotation and the scale of a mesh, as far as they have changed.
fn pose(table: &mut Table, before: &MeshSource, now: &MeshSource) {
    if before.position != now.position {
        table.insert("position", vector(now.position));
    }
    if before.rotation != now.rotation {
        table.insert("rotation", degrees(now.rotation));
    }
    if before.scale != now.scale {
        table.insert("scale", scale(now));
    }
}

fn scale(mesh: &MeshSource) -> Item {
    let uniform = mesh.scale == Vec3::splat(mesh.scale.x);
    if uniform { number(mesh.scale.x) } else { vector(mesh.scale) }
}

/// Replaces rotations and directions that were read from rounded numbers by those of the scene from which the numbers were
/// made.
pub fn adopt_rotations(read: &mut Scene, scene: &Scene) {
    let adopt = |read: &mut MeshSource, scene: &MeshSource| {
        if read.rotation.dot(scene.rotation).abs() > 1.0 - 1e-6 {
            read.rotation = scene.rotation;
        }
    };
    for (read, body) in read.bodies.iter_mut().zip(&scene.bodies) {
        adopt(&mut read.mesh, &body.mesh);
    }
    for (read, filled) in read.fluid.meshes.iter_mut().zip(&scene.fluid.meshes) {
        adopt(&mut read.mesh, &filled.mesh);
    }
    for (read, emitter) in read.emitters.iter_mut().zip(&scene.emitters) {
        if read.direction.dot(emitter.direction) > 1.0 - 1e-6 {
            read.direction = emitter.direction;
        }
    }
}

/// The tables `[[name]]`, also if the file writes them as inline tables.
fn tables<'a>(parent: &'a mut dyn TableLike, name: &str) -> Option<&'a mut ArrayOfTables> {
    let item = parent.entry(name).or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
    if !item.is_array_of_tables() {
        *item = Item::ArrayOfTables(std::mem::take(item).into_array_of_tables().unwrap_or_default());
    }
    item.as_array_of_tables_mut()
}

/// A mesh with its pose.
fn mesh_table(mesh: &MeshSource) -> Result<Table, String> {
    let mut table = Table::new();
    let name = match &mesh.shape {
        MeshShape::Model(name) => name.clone(),
        MeshShape::File(path) => path.to_str().ok_or("the path of a mesh is not valid text")?.to_owned(),
    };
    table.insert("mesh", value(name));
    table.insert("scale", scale(mesh));
    table.insert("position", vector(mesh.position));
    if mesh.rotation != Quat::IDENTITY {
        table.insert("rotation", degrees(mesh.rotation));
    }
    Ok(table)
}

fn body_table(body: &Body) -> Result<Table, String> {
    let mut table = Table::new();
    table.insert("name", value(&body.name));
    for (key, item) in mesh_table(&body.mesh)? {
        table.insert(&key, item);
    }
    let Motion::Dynamic { density, .. } = body.motion else {
        return Err("only dynamic bodies can be added to a scene file".to_owned());
    };
    table.insert("motion", value("dynamic"));
    table.insert("density", number(density));
    table.insert("friction", number(body.friction));
    if let Some(colour) = body.colour {
        table.insert("colour", vector(Vec3::from(colour)));
    }
    Ok(table)
}

fn emitter_table(emitter: &Emitter) -> Result<Table, String> {
    let Outlet::Disc { radius } = emitter.outlet else {
        return Err("only disc emitters can be added to a scene file".to_owned());
    };
    let mut table = Table::new();
    table.insert("name", value(&emitter.name));
    table.insert("shape", value("disc"));
    table.insert("radius", number(radius));
    table.insert("position", vector(emitter.position));
    table.insert("direction", direction(emitter.direction));
    table.insert("speed", number(emitter.speed));
    if let Some(max_particles) = emitter.max_particles {
        table.insert("max_particles", value(i64::from(max_particles)));
    }
    Ok(table)
}
