//! Plots of tables, drawn by `plotters` with a font that the program brings along.

pub mod draw;
pub mod table;
