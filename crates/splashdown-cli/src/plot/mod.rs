//! Plots of tables, drawn by `plotters` with a built-in font.

pub mod draw;
pub mod table;
