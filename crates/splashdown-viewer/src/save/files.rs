//! Files that a scene names, relative to the folder of the scene file.

use std::path::Path;

use toml_edit::{DocumentMut, Item, TableLike, Value};

/// Sections without names of files.
const TEXTS: [&str; 3] = ["scene", "picture", "output"];

/// Replaces relative names of files in this folder by absolute ones.
pub fn make_absolute(document: &mut DocumentMut, folder: &Path) {
    for (name, item) in document.as_table_mut().iter_mut() {
        if !TEXTS.contains(&name.get()) {
            make_item_absolute(item, folder);
        }
    }
}

fn make_item_absolute(item: &mut Item, folder: &Path) {
    match item {
        Item::ArrayOfTables(tables) => {
            tables.iter_mut().for_each(|table| make_table_absolute(table, folder));
        }
        Item::Table(table) => make_table_absolute(table, folder),
        Item::Value(value) => make_value_absolute(value, folder),
        Item::None => {}
    }
}

fn make_table_absolute(table: &mut dyn TableLike, folder: &Path) {
    table.iter_mut().for_each(|(_, item)| make_item_absolute(item, folder));
}

fn make_value_absolute(value: &mut Value, folder: &Path) {
    match value {
        Value::InlineTable(table) => make_table_absolute(table, folder),
        Value::Array(values) => values.iter_mut().for_each(|value| make_value_absolute(value, folder)),
        Value::String(text) => {
            // As a scene file distinguishes a file from a model.
            let is_name = text.value().contains(['.', '/', '\\']);
            let path = folder.join(text.value());
            if let (true, true, Some(path)) = (is_name, path.is_file(), path.to_str()) {
                let decor = value.decor().clone();
                *value = path.into();
                *value.decor_mut() = decor;
            }
        }
        _ => {}
    }
}
