//! Tests of the command line. They start the program and check its output, exit codes and files.

mod bad_input;
mod bursts;
#[cfg(target_os = "linux")]
mod checkpoints;
mod guide;
mod hostile;
mod interrupted;
mod meshes;
mod place;
mod plot;
mod render;
mod resume;
mod runs;
mod splashsurf;
mod surface;
mod words;
