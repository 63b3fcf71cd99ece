//! Statistics of a simulation.

use pyo3::prelude::*;
use pyo3::types::PyDict;

macro_rules! stats {
    ($($(#[$doc:meta])* $name:ident: $kind:ty),+ $(,)?) => {
        /// The state of a simulation at the end of a call of `advance`, or of a frame. Totals count from the start.
        ///
        /// >>> stats = simulation.advance(0.005)
        /// >>> stats.escaped, stats.steps >= stats.steps_in_frame
        /// (0, True)
        #[pyclass(frozen, get_all, module = "splashdown")]
        #[derive(Clone, Copy)]
        pub struct Stats {
            $($(#[$doc])* $name: $kind),+
        }

        impl From<splashdown::Stats> for Stats {
            fn from(stats: splashdown::Stats) -> Self {
                Self { $($name: stats.$name),+ }
            }
        }

        #[pymethods]
        impl Stats {
            /// All values by name, for example for a row of a table.
            ///
            /// >>> simulation.stats.to_dict()["particles"] == len(simulation)
            /// True
            fn to_dict<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
                let (values, stats) = (PyDict::new(this.py()), this.get());
                $(values.set_item(stringify!($name), stats.$name)?;)+
                Ok(values)
            }

            fn __repr__(&self) -> String {
                let parts = [$(format!(concat!(stringify!($name), "={:?}"), self.$name)),+];
                format!("Stats({})", parts.join(", "))
            }
        }
    };
}

stats! {
    /// Simulated time in s.
    time: f64,
    /// Steps since the start.
    steps: u64,
    /// Steps of this call.
    steps_in_frame: u32,
    /// The last time step in s.
    dt: f32,
    /// Particles inside the domain.
    particles: u32,
    /// Particles created by emitters.
    emitted: u32,
    /// Particles that emitters could not create because the buffers were full.
    refused: u32,
    /// Particles removed by sinks.
    drained: u32,
    /// Particles that left through open sides.
    escaped: u32,
    /// Particles removed because their position or velocity became NaN or infinite.
    non_finite: u32,
    /// How often a particle was moved back from behind a wall or out of a body.
    wall_corrections: u32,
    /// Particles inside a body at the end of a frame of a `Run`.
    inside_bodies: u32,
    /// How often a velocity was limited to half a spacing per step.
    speed_limits: u32,
    /// The largest relative excess of density over the rest density in this call.
    density_error: f32,
    /// The largest speed at the end of this call in m/s.
    max_speed: f32,
}
