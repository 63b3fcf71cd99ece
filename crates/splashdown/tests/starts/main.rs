//! Sound starts: a pool at rest stays at rest, wherever bodies touch walls, floors and one another, and however the
//! fluid is put together.
//!
//! The tests run a part of the matrix. `SPLASHDOWN_FULL=1` runs all of it; `STARTS=case` and `STARTS_FORM=form` restrict it
//! to cases and forms of the equations whose names contain the word, and `STARTS_SPACING` is another spacing in m.

mod bodies;
#[path = "../meshes/mod.rs"]
mod meshes;
mod pieces;
mod pool;
