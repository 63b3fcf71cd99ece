//! Probes: measurements during a simulation, like those of gauges in a laboratory.
//!
//! *How it works.* In every step the device evaluates each probe (`sample`, `flux`) and accumulates the values. When a
//! row is due it writes their mean since the previous row (`accumulate`), and the pose of a body at this time. The host
//! fetches the rows once per frame. Where it resolves contacts after a step that has written the pose of a body, it corrects
//! the row. The volume of a particle is spacing^3. Its mass is slightly less than the rest density times this volume, because the sum
//! of the kernel over a lattice exceeds one.

mod accumulate;
mod fluid;
mod flux;
mod sample;
mod types;

pub(crate) use fluid::FluidProbes;
#[doc(hidden)]
pub use types::{Account, POSE, PROBE, ProbePoint, ROW, VALUES};

use glam::Vec3;
use splashdown_gpu::{Buffer, BufferSet, DispatchSize, Executor, GpuError, PassDesc};

use crate::bodies::{Bodies, Body, BodyState, state_of};
use crate::coupling::{Coupling, Stage, StepRecorder};
use crate::scene::{Domain, Probe, Quantity, Scene};

/// Additional rows, for rounding and for rows that were due before the frame.
const SPARE_ROWS: u64 = 64;

/// The passes of this module.
#[doc(hidden)]
pub fn passes() -> Vec<&'static PassDesc> {
    vec![&sample::SAMPLE, &flux::FLUX, &accumulate::ACCUMULATE]
}

/// The rows of a probe: each is the time in s at its end, then the mean values since the previous row. Poses and velocities
/// of bodies are those at the time of the row. [`columns`] names the values.
pub type ProbeRows = Vec<Vec<f64>>;

/// The names of a probe's columns with units; the first is the time.
pub fn columns(probe: &Probe) -> &'static [&'static str] {
    match probe.quantity {
        Quantity::Pressure(_) => &["time (s)", "pressure (Pa)"],
        Quantity::Height(_) => &["time (s)", "height (m)"],
        Quantity::Force(_) => &[
            "time (s)",
            "force x (N)",
            "force y (N)",
            "force z (N)",
            "torque x (N m)",
            "torque y (N m)",
            "torque z (N m)",
        ],
        Quantity::Body(_) => &BodyState::COLUMNS,
        Quantity::Flow { .. } => &["time (s)", "flow (m^3/s)"],
        Quantity::Fluid { .. } => fluid::COLUMNS,
        Quantity::Energy => fluid::BALANCE,
    }
}

/// The probes of a simulation, on its device.
#[derive(Debug)]
#[doc(hidden)]
pub struct Probes {
    /// The number of columns of each probe.
    columns: Vec<usize>,
    points: Vec<ProbePoint>,
    /// The longest frame in s whose rows fit.
    longest_frame: f32,
    has_flow: bool,
    probes: Buffer<ProbePoint>,
    /// The bodies; a single unused one if the scene has none.
    bodies: Buffer<Body>,
    values: Buffer<f32>,
    counts: Buffer<u32>,
    accounts: Buffer<u32>,
    rows: Buffer<f32>,
}

impl Probes {
    /// Creates the buffers of a scene's probes on a device; `None` if the scene has none.
    ///
    /// # Errors
    /// As [`Executor::create`].
    pub fn new(
        executor: &mut Executor,
        scene: &Scene,
        bodies: Option<&Bodies>,
    ) -> Result<Option<Self>, GpuError> {
        if scene.probes.is_empty() {
            return Ok(None);
        }
        let mut points: Vec<ProbePoint> = scene.probes.iter().map(|probe| point_of(probe, scene)).collect();
        let mut accounts = vec![0; points.len() * Account::WORDS];
        for (point, account) in points.iter().zip(accounts.chunks_exact_mut(Account::WORDS)) {
            account[Account::NEXT] = point.interval.to_bits();
        }
        let rows = assign_rows(&mut points, scene.frame_duration());
        Ok(Some(Self {
            longest_frame: scene.frame_duration(),
            columns: scene.probes.iter().map(|probe| columns(probe).len()).collect(),
            has_flow: points.iter().any(|point| point.kind == ProbePoint::FLOW),
            probes: executor.create_from("probes", &points)?,
            bodies: match bodies {
                Some(bodies) => bodies.bodies,
                None => executor.create("bodies", 1)?,
            },
            values: executor.create("probe_values", points.len() * VALUES)?,
            counts: executor.create_from("probe_counts", &vec![0; points.len()])?,
            accounts: executor.create_from("probe_accounts", &accounts)?,
            rows: executor.create("probe_rows", length_of(rows))?,
            points,
        }))
    }

    /// Makes room for the rows of a frame of this many seconds. Call it between two frames, when no rows are stored.
    ///
    /// # Errors
    /// As [`Executor::create`].
    pub(crate) fn reserve(&mut self, executor: &mut Executor, seconds: f32) -> Result<(), GpuError> {
        if seconds <= self.longest_frame {
            return Ok(());
        }
        let mut points = self.points.clone();
        let rows = assign_rows(&mut points, seconds);
        // Too many rows are an error here, before anything has changed.
        executor.resize(&mut self.rows, length_of(rows))?;
        executor.write(self.probes, &points)?;
        (self.points, self.longest_frame) = (points, seconds);
        Ok(())
    }

    /// Replaces the poses in the rows that the last step has written by those of these states, because contacts have changed
    /// the bodies after this step.
    ///
    /// # Errors
    /// If the device was lost.
    pub(crate) async fn correct_poses(
        &self,
        executor: &mut Executor,
        states: &[Body],
    ) -> Result<(), GpuError> {
        if !self.points.iter().any(|point| point.kind == ProbePoint::BODY) {
            return Ok(());
        }
        let accounts = executor.fetch(self.accounts).await?;
        let mut rows = executor.fetch(self.rows).await?;
        let mut is_corrected = false;
        for (point, account) in self.points.iter().zip(accounts.chunks_exact(Account::WORDS)) {
            let written = account[Account::ROWS] as usize;
            // No time has passed since a row of the last step.
            if point.kind == ProbePoint::BODY && written > 0 && account[Account::TIME] == 0 {
                let at = (point.first_row as usize + written - 1) * ROW;
                rows[at + 1..][..POSE].copy_from_slice(&pose_of(&states[point.body as usize]));
                is_corrected = true;
            }
        }
        if is_corrected { executor.write(self.rows, &rows) } else { Ok(()) }
    }

    /// The buffers of the probes' state from step to step.
    pub(crate) fn memory(&self) -> [Buffer<u32>; 2] {
        [self.accounts, self.counts]
    }

    /// Fetches the rows of a frame that began at `start` (s) and lasted `passed` (s): one list per probe, in the order
    /// of the scene.
    ///
    /// # Errors
    /// If the device was lost.
    pub async fn take(
        &self,
        executor: &mut Executor,
        start: f64,
        passed: f32,
    ) -> Result<Vec<ProbeRows>, GpuError> {
        let mut accounts = executor.fetch(self.accounts).await?;
        let rows = executor.fetch(self.rows).await?;
        let mut taken = Vec::with_capacity(self.points.len());
        for ((point, columns), account) in
            self.points.iter().zip(&self.columns).zip(accounts.chunks_exact_mut(Account::WORDS))
        {
            let first = point.first_row as usize * ROW;
            let written = rows[first..].chunks_exact(ROW).take(account[Account::ROWS] as usize);
            let row = |row: &[f32]| {
                let values = row[1..*columns].iter().map(|&value| f64::from(value));
                std::iter::once(start + f64::from(row[0])).chain(values).collect()
            };
            taken.push(written.map(row).collect());
            account[Account::ROWS] = 0;
            let next = f32::from_bits(account[Account::NEXT]) - passed;
            account[Account::NEXT] = next.to_bits();
        }
        executor.write(self.accounts, &accounts)?;
        Ok(taken)
    }
}

/// The pose of a body in a row: position, orientation, velocity and angular velocity of the mesh's origin.
fn pose_of(body: &Body) -> [f32; POSE] {
    let state = state_of(body);
    let [[x, y, z], [u, v, w], [a, b, c]] =
        [state.position, state.velocity, state.angular_velocity].map(|vector| vector.to_array());
    let [i, j, k, r] = state.orientation.to_array();
    [x, y, z, i, j, k, r, u, v, w, a, b, c]
}

/// Gives each probe its part of the rows, for frames of up to this many seconds. Returns the number of all rows, which may
/// be too many for a buffer.
fn assign_rows(points: &mut [ProbePoint], seconds: f32) -> u64 {
    let mut rows = 0_u64;
    for point in points {
        let most = ((seconds / point.interval).ceil() as u64).saturating_add(SPARE_ROWS);
        (point.first_row, point.most_rows) = (rows as u32, most as u32);
        rows = rows.saturating_add(most);
    }
    rows
}

/// The length of the buffer of so many rows.
fn length_of(rows: u64) -> usize {
    usize::try_from(rows).unwrap_or(usize::MAX).saturating_mul(ROW)
}

impl Coupling for Probes {
    fn stages(&self) -> &'static [Stage] {
        &[Stage::Measurement]
    }

    fn buffers(&self) -> BufferSet {
        let Self { probes, bodies, values, counts, accounts, rows, .. } = *self;
        let mut buffers = BufferSet::new();
        buffers.add("probes", probes);
        buffers.add("bodies", bodies);
        buffers.add("probe_values", values);
        buffers.add("probe_counts", counts);
        buffers.add("probe_accounts", accounts);
        buffers.add("probe_rows", rows);
        buffers
    }

    fn record(&self, _: Stage, step: &mut StepRecorder<'_>) {
        step.dispatch(&sample::SAMPLE, DispatchSize::Groups(self.points.len() as u32));
        if self.has_flow {
            step.dispatch_particles(&flux::FLUX);
        }
        step.dispatch(&accumulate::ACCUMULATE, DispatchSize::Items(self.probes.len()));
    }
}

/// The device's representation of a probe, except the index of its rows.
fn point_of(probe: &Probe, scene: &Scene) -> ProbePoint {
    let standard = match probe.quantity {
        // Evaluated by the host, and never due on the device.
        Quantity::Fluid { .. } | Quantity::Energy => f32::MAX,
        _ => 0.1 * scene.frame_duration(),
    };
    let interval = probe.interval.unwrap_or(standard);
    let mut point = ProbePoint { interval, ..bytemuck::Zeroable::zeroed() };
    match &probe.quantity {
        Quantity::Pressure(position) => {
            point.kind = ProbePoint::PRESSURE;
            point.position = *position;
        }
        Quantity::Height(foot) => {
            point.kind = ProbePoint::HEIGHT;
            point.normal = (-scene.gravity).try_normalize().unwrap_or(Vec3::Y);
            point.position = off_walls(scene, *foot, point.normal);
            point.half_along = distance_to_side(scene, point.position, point.normal);
        }
        Quantity::Force(name) | Quantity::Body(name) => {
            let is_force = matches!(probe.quantity, Quantity::Force(_));
            point.kind = if is_force { ProbePoint::FORCE } else { ProbePoint::BODY };
            let place = scene.bodies.iter().position(|body| body.name == *name);
            point.body = place.unwrap_or_default() as u32;
        }
        Quantity::Flow { center, normal, along, size } => {
            point.kind = ProbePoint::FLOW;
            point.position = *center;
            point.normal = *normal;
            point.along = *along;
            point.across = normal.cross(*along);
            [point.half_along, point.half_across] = size.map(|edge| 0.5 * edge);
        }
        Quantity::Fluid { .. } | Quantity::Energy => point.kind = ProbePoint::FLUID,
    }
    point
}

/// Moves the base of a column away from the closed sides, so that the column does not intersect them.
fn off_walls(scene: &Scene, foot: Vec3, up: Vec3) -> Vec3 {
    let radius = sample::COLUMN * scene.solver.support_radius(scene.fluid.particle_spacing);
    let Domain { min, max, closed, .. } = scene.domain;
    let mut place = foot;
    for axis in (0..3).filter(|&axis| up[axis].abs() < 0.5) {
        if max[axis] - min[axis] <= 2.0 * radius {
            continue;
        }
        if closed[axis][0] {
            place[axis] = place[axis].max(min[axis] + radius);
        }
        if closed[axis][1] {
            place[axis] = place[axis].min(max[axis] - radius);
        }
    }
    place
}

/// The distance in m from a point of the domain to its side, along a direction.
fn distance_to_side(scene: &Scene, from: Vec3, direction: Vec3) -> f32 {
    let ends = [scene.domain.min, scene.domain.max];
    let distances = (0..3).filter(|&axis| direction[axis].abs() > 1e-6).map(|axis| {
        let end = ends[usize::from(direction[axis] > 0.0)][axis];
        (end - from[axis]) / direction[axis]
    });
    distances.fold(f32::MAX, f32::min).max(0.0)
}
