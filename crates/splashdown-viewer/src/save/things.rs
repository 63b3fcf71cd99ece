//! Blocks of fluid, bodies and emitters of a changed scene.

use glam::Vec3;
use splashdown::scene::{Block, Body, Emitter, MeshShape, Motion, Outlet, Shape};
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, TableLike, value};

use super::values::{number, vector};

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

/// Writes moved, removed and added bodies.
///
/// # Errors
/// A message, if a scene file cannot express an added body.
pub fn bodies(document: &mut DocumentMut, old: &[Body], new: &[Body]) -> Result<(), String> {
    let moved = |table: &mut Table, body: &Body| {
        table.insert("position", vector(body.mesh.position));
        if let (true, Motion::Dynamic { hinge: Some(hinge), .. }) =
            (table.contains_key("hinge_point"), &body.motion)
        {
            table.insert("hinge_point", vector(hinge.point));
        }
    };
    named(document, "body", old, new, |body| &body.name, moved, body_table)
}

/// Writes moved, removed and added emitters.
///
/// # Errors
/// A message, if a scene file cannot express an added emitter.
pub fn emitters(document: &mut DocumentMut, old: &[Emitter], new: &[Emitter]) -> Result<(), String> {
    let moved = |table: &mut Table, emitter: &Emitter| {
        table.insert("position", vector(emitter.position));
    };
    named(document, "emitter", old, new, |emitter| &emitter.name, moved, emitter_table)
}

/// Writes the differences of a list of things with unique names.
fn named<T: PartialEq>(
    document: &mut DocumentMut,
    key: &str,
    old: &[T],
    new: &[T],
    name: fn(&T) -> &str,
    moved: impl Fn(&mut Table, &T),
    table: fn(&T) -> Result<Table, String>,
) -> Result<(), String> {
    if old == new {
        return Ok(());
    }
    let list =
        tables(document.as_table_mut(), key).ok_or_else(|| format!("`{key}` is not a list of tables"))?;
    let now = |thing: &T| new.iter().find(|other| name(other) == name(thing));
    for (index, thing) in old.iter().enumerate().rev() {
        match now(thing) {
            None => drop(list.remove(index)),
            Some(other) if other == thing => {}
            Some(other) => {
                if let Some(table) = list.get_mut(index) {
                    moved(table, other);
                }
            }
        }
    }
    for thing in new.iter().filter(|thing| !old.iter().any(|other| name(other) == name(thing))) {
        list.push(table(thing)?);
    }
    Ok(())
}

/// The tables `[[name]]`, also if the file writes them as inline tables.
fn tables<'a>(parent: &'a mut dyn TableLike, name: &str) -> Option<&'a mut ArrayOfTables> {
    let item = parent.entry(name).or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
    if !item.is_array_of_tables() {
        *item = Item::ArrayOfTables(std::mem::take(item).into_array_of_tables().unwrap_or_default());
    }
    item.as_array_of_tables_mut()
}

fn body_table(body: &Body) -> Result<Table, String> {
    let mut table = Table::new();
    table.insert("name", value(&body.name));
    let mesh = match &body.mesh.shape {
        MeshShape::Model(name) => name.clone(),
        MeshShape::File(path) => path.to_str().ok_or("the path of a mesh is not valid text")?.to_owned(),
    };
    table.insert("mesh", value(mesh));
    let scale = body.mesh.scale;
    let uniform = scale == Vec3::splat(scale.x);
    table.insert("scale", if uniform { number(scale.x) } else { vector(scale) });
    table.insert("position", vector(body.mesh.position));
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
    table.insert("direction", vector(emitter.direction));
    table.insert("speed", number(emitter.speed));
    if let Some(max_particles) = emitter.max_particles {
        table.insert("max_particles", value(i64::from(max_particles)));
    }
    Ok(table)
}
