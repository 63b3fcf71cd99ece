//! The table of a body: its state in every frame, as CSV.

use std::fs;
use std::path::Path;

use splashdown::BodyState;
use splashdown::glam::{Quat, Vec3};
use splashdown_io::IoError;

use crate::RunError;

/// The names of the columns.
pub(crate) const COLUMNS: [&str; 20] = BodyState::COLUMNS;

/// The row of a state at a time in s.
pub(crate) fn row(time: f64, state: &BodyState) -> Vec<f64> {
    let BodyState { position, orientation, velocity, angular_velocity, force, torque, .. } = *state;
    let vectors = [velocity, angular_velocity, force, torque].map(|vector| vector.to_array());
    let values =
        position.to_array().into_iter().chain(orientation.to_array()).chain(vectors.into_iter().flatten());
    [time].into_iter().chain(values.map(shortest)).collect()
}

/// The number with the fewest digits that is rounded to this one, so that the file has 0.1 and not 0.10000000149011612.
fn shortest(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(f64::from(value))
}

/// The row of a table at a time in s, or `None` if it has no row within `tolerance` (s) of it. Forces are not read.
///
/// # Errors
/// As [`read_all`].
pub(crate) fn read(path: &Path, time: f64, tolerance: f64) -> Result<Option<BodyState>, RunError> {
    let rows = read_all(path)?.into_iter().filter(|(at, _)| (at - time).abs() <= tolerance);
    let nearest = rows.min_by(|(a, _), (b, _)| (a - time).abs().total_cmp(&(b - time).abs()));
    Ok(nearest.map(|(_, state)| state))
}

/// All complete rows of a table with finite numbers: times in s and states. Forces are not read.
///
/// # Errors
/// [`RunError::Io`] if the file cannot be read; [`RunError::Input`] if it is not the table of a body.
pub(crate) fn read_all(path: &Path) -> Result<Vec<(f64, BodyState)>, RunError> {
    let text = fs::read_to_string(path)
        .map_err(|error| IoError::Read { path: path.to_owned(), detail: error.to_string() })?;
    let mut lines = text.lines();
    if lines.next() != Some(&COLUMNS.join(",")) {
        return Err(RunError::Input(format!("`{}` is not the table of a body", path.display())));
    }
    let rows = lines.filter_map(|line| {
        let values = line.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>().ok()?;
        let is_whole = values.len() == COLUMNS.len() && values.iter().all(|value| value.is_finite());
        is_whole.then(|| (values[0], state(&values)))
    });
    Ok(rows.collect())
}

/// The state in a row.
fn state(row: &[f64]) -> BodyState {
    let number = |index: usize| row[index] as f32;
    let vector = |first: usize| Vec3::new(number(first), number(first + 1), number(first + 2));
    let mut state = BodyState::at(vector(1), Quat::from_xyzw(number(4), number(5), number(6), number(7)));
    (state.velocity, state.angular_velocity) = (vector(8), vector(11));
    state
}

#[cfg(test)]
mod tests {
    use super::*;
    use splashdown_io::CsvLog;

    #[test]
    fn a_state_is_read_as_it_was_written() -> Result<(), RunError> {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("crate.csv");
        let mut log = CsvLog::create(&path, &COLUMNS)?;
        let state = |i: i32| {
            let turn = Quat::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), 0.1 * i as f32);
            let mut state = BodyState::at(Vec3::new(0.1, 1.0 / 3.0, -1e-7) * i as f32, turn);
            state.velocity = Vec3::splat(0.3);
            state
        };
        for i in 0..5 {
            log.row(&row(0.02 * f64::from(i), &state(i)))?;
        }
        assert_eq!(read(&path, 0.06, 0.01)?, Some(state(3)));
        // Control: other frames have other states, and a time without a row has none.
        assert_ne!(read(&path, 0.04, 0.01)?, Some(state(3)));
        assert_eq!(read(&path, 0.2, 0.01)?, None);
        // A damaged and an incomplete row are left out.
        let text = fs::read_to_string(&path).expect("a table").replacen("0.06,", "nan,", 1);
        fs::write(&path, &text[..text.len() - 9]).expect("written");
        assert_eq!(read_all(&path)?.into_iter().map(|(time, _)| time).collect::<Vec<_>>(), [0.0, 0.02, 0.04]);
        fs::write(&path, "time (s),force x (N)\n0,1\n").expect("written");
        assert!(matches!(read(&path, 0.0, 0.01), Err(RunError::Input(_))));
        assert!(matches!(read(&folder.path().join("none.csv"), 0.0, 0.01), Err(RunError::Io(_))));
        Ok(())
    }
}
