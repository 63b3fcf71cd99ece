//! What the command line and the window share: how a scene's frames become pictures.

pub mod stage;
