//! Changes of single keys of a scene.

use toml::{Table, Value};

use crate::errors::{Result, SceneError};

/// Sets the value at a path such as `solver.cfl_factor` or `fluid.block[0].size`. Sections that are missing are created;
/// elements of lists must exist.
///
/// # Errors
/// `SceneError` for a path that does not fit the scene.
pub fn apply(table: &mut Table, path: &str, value: Value) -> Result<()> {
    let mut names = path.split('.').peekable();
    let mut table = table;
    while let Some(name) = names.next() {
        let is_last = names.peek().is_none();
        let (key, index) = split(path, name)?;
        let Some(index) = index else {
            if is_last {
                table.insert(key.to_owned(), value);
                return Ok(());
            }
            let entry = table.entry(key).or_insert_with(|| Value::Table(Table::new()));
            table = entry.as_table_mut().ok_or_else(|| {
                fail(
                    path,
                    &format!("{key} is not a section; elements of a list have an index, as in {key}[0]"),
                )
            })?;
            continue;
        };
        let list = table.get_mut(key).and_then(Value::as_array_mut);
        let length = list.as_ref().map_or(0, |list| list.len());
        let Some(element) = list.and_then(|list| list.get_mut(index)) else {
            return Err(fail(path, &format!("the scene has {length} elements in {key}, counted from 0")));
        };
        if is_last {
            *element = value;
            return Ok(());
        }
        table = element.as_table_mut().ok_or_else(|| fail(path, &format!("{name} is not a section")))?;
    }
    Ok(())
}

/// Sets the keys of a section, and of the sections in it; lists and values are replaced.
pub fn merge(table: &mut Table, key: &str, value: Value) {
    match (table.get_mut(key), value) {
        (Some(Value::Table(old)), Value::Table(new)) => {
            for (key, value) in new {
                merge(old, &key, value);
            }
        }
        (_, value) => {
            table.insert(key.to_owned(), value);
        }
    }
}

/// A name and its index, if any.
fn split<'a>(path: &str, name: &'a str) -> Result<(&'a str, Option<usize>)> {
    let Some((key, rest)) = name.split_once('[') else {
        if name.is_empty() {
            return Err(fail(path, "it has an empty name"));
        }
        return Ok((name, None));
    };
    match rest.strip_suffix(']').and_then(|index| index.parse().ok()) {
        Some(index) => Ok((key, Some(index))),
        None => Err(fail(path, &format!("{name:?} has no index such as [0]"))),
    }
}

fn fail(path: &str, what: &str) -> crate::errors::Failure {
    let message = format!("the path {path:?} does not fit the scene: {what}");
    SceneError::new_err((message.clone(), vec![message])).into()
}
