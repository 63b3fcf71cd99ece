//! Saving and resuming a simulation.

use splashdown_gpu::{Buffer, Executor, GpuElement, block_on};
use splashdown_io::{Archive, NpyElement};

use super::Simulation;
use crate::check::Built;
use crate::checkpoint::{Checkpoint, CheckpointError, HostState};
use crate::schemes::Scheme;
use crate::state::{Carried, CarriedArrays, Kind, StepCounters};
use crate::{SimulationError, memory, schemes};

impl Simulation {
    /// Returns a checkpoint from which the simulation can be resumed. A frame in progress is completed first.
    /// `scene_text` is the text of the scene that is simulated now: [`Scene::text`](crate::scene::Scene::text), unless
    /// [`update_parameters`](Self::update_parameters) has replaced the scene.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub fn checkpoint(&mut self, scene_text: &str) -> Result<Checkpoint, SimulationError> {
        block_on(self.checkpoint_async(scene_text))
    }

    /// [`checkpoint`](Self::checkpoint) where blocking is not possible, as on a web page.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub async fn checkpoint_async(&mut self, scene_text: &str) -> Result<Checkpoint, SimulationError> {
        while self.continue_frame_async().await?.is_none() {}
        let mut archive = Archive::default();
        for (name, buffer, columns) in self.words() {
            archive.set_array(name, &buffer.fetch(&mut self.executor).await?, columns);
        }
        for (quantity, values) in self.fetch_carried().await? {
            let (words, columns) = (values.words(), quantity.kind.components());
            match quantity.kind {
                Kind::U32 => archive.set_array(quantity.name, words, columns),
                _ => archive.set_array(quantity.name, bytemuck::cast_slice::<u32, f32>(words), columns),
            }
        }
        let mut host = HostState {
            stats: self.stats,
            stable_dt: self.stable_dt,
            sound_speed: self.params.sound_speed,
            capacity: self.params.particle_count,
            initial: self.initial,
            removed: self.removed,
            reported: Vec::new(),
            bodies: Vec::new(),
            flow: 0,
        };
        if let Some(flow) = &self.flow {
            host.flow = flow.hash();
            host.reported = flow.reported().to_vec();
        }
        if let Some(bodies) = &self.bodies {
            host.bodies = bodies.keys();
            archive.set_array(
                "bodies",
                &bodies.fetch_motion(&mut self.executor).await?,
                bodies.motion_columns(),
            );
        }
        let device = self.executor.gpu().map_or_else(|| "CPU".to_owned(), |gpu| gpu.name());
        let mut checkpoint = Checkpoint::new(archive, &self.scene, scene_text, device, &host);
        if let Some(bodies) = &self.bodies {
            checkpoint.set("collisions.bin", bodies.collisions());
        }
        Ok(checkpoint)
    }

    /// Resumes a simulation from a checkpoint on any device. On the CPU, and on the GPU that made the checkpoint, the
    /// resumed run is bit-identical to an uninterrupted one.
    ///
    /// # Errors
    /// As [`new`](Self::new), and [`SimulationError::Checkpoint`] if the scene of the checkpoint is no longer usable.
    pub fn resume(checkpoint: &Checkpoint, executor: Executor) -> Result<Self, SimulationError> {
        block_on(Self::resume_async(checkpoint, executor, &|_, _| {}))
    }

    /// [`resume`](Self::resume) where blocking is not possible, as on a web page; `progress` as in
    /// [`prepare`](Self::prepare).
    ///
    /// # Errors
    /// As [`resume`](Self::resume).
    pub async fn resume_async(
        checkpoint: &Checkpoint,
        executor: Executor,
        progress: &(dyn Fn(&str, f32) + Sync),
    ) -> Result<Self, SimulationError> {
        let table = Scheme::new(&checkpoint.scene()?).carried();
        Self::resume_with_table(checkpoint, executor, progress, table).await
    }

    pub(super) async fn resume_with_table(
        checkpoint: &Checkpoint,
        executor: Executor,
        progress: &(dyn Fn(&str, f32) + Sync),
        table: &'static [Carried],
    ) -> Result<Self, SimulationError> {
        // Validates the sizes before buffers of these sizes are created.
        checkpoint.check()?;
        let scene = checkpoint.scene()?;
        let built = Built::of(&scene);
        let host = checkpoint.host()?;
        let loaded = Self::load_bodies(&scene, progress)?;
        let loaded_flow = built.flow(&scene)?;
        memory::check_particles(u64::from(host.capacity), executor.largest_buffer(), &scene)?;
        let mut simulation = Self::assemble(&scene, executor, host.capacity, 0, loaded, &loaded_flow, table)?;
        simulation.restore(checkpoint, host).await?;
        Ok(simulation)
    }

    async fn restore(&mut self, checkpoint: &Checkpoint, host: HostState) -> Result<(), SimulationError> {
        let n = host.capacity as usize;
        for CarriedArrays { quantity, persistent, .. } in self.fields.carried.clone() {
            let numbers = n * quantity.kind.components();
            let words = match quantity.kind {
                Kind::U32 => checkpoint.numbers::<u32>(quantity.name, numbers)?,
                _ => {
                    checkpoint.numbers::<f32>(quantity.name, numbers)?.into_iter().map(f32::to_bits).collect()
                }
            };
            persistent.write(&mut self.executor, &words)?;
        }
        for (name, buffer, _) in self.words() {
            let words = checkpoint.numbers::<u32>(name, buffer.words())?;
            buffer.write(&mut self.executor, &words)?;
        }
        self.params = schemes::params(&self.scene, host.capacity);
        self.params.sound_speed = host.sound_speed;
        if let Some(bodies) = &self.bodies {
            self.params = bodies.limit_step(self.params);
        }
        self.executor.write(self.fields.params, &[self.params])?;
        if let Some(flow) = &mut self.flow {
            if flow.hash() != host.flow {
                return Err(CheckpointError::FlowChanged.into());
            }
            flow.set_reported(&host.reported);
        }
        if let Some(bodies) = &mut self.bodies {
            bodies.check_keys(&host.bodies).map_err(CheckpointError::from)?;
            let motion = checkpoint.numbers("bodies", bodies.keys().len() * bodies.motion_columns())?;
            bodies.restore(&mut self.executor, &motion, checkpoint.get("collisions.bin")?).await?;
        }
        (self.stats, self.stable_dt) = (host.stats, host.stable_dt);
        (self.initial, self.removed) = (host.initial, host.removed);
        let counters = self.executor.fetch(self.fields.counters).await?;
        let stats = &self.stats;
        let counted = [stats.escaped, stats.non_finite, stats.drained];
        if counted
            != [StepCounters::ESCAPED, StepCounters::NON_FINITE, StepCounters::DRAINED]
                .map(|word| counters[word])
        {
            let reason = "its entry `tally` contradicts its counts of particles".to_owned();
            return Err(CheckpointError::Malformed(reason).into());
        }
        // A step that has not ended would end a second time.
        if counters[StepCounters::MOVED] != 0 {
            let reason = "its entry `tally` belongs to an unfinished step".to_owned();
            return Err(CheckpointError::Malformed(reason).into());
        }
        Ok(())
    }

    /// The small buffers whose content cannot be derived from the scene, with their names in the file and their
    /// numbers of columns.
    fn words(&self) -> Vec<(&'static str, Words, usize)> {
        let mut words = vec![
            ("state", Words::State(self.fields.state), 1),
            ("tally", Words::Plain(self.fields.counters), 1),
        ];
        if let Some(bodies) = &self.bodies {
            words.push(("body_sums", Words::Plain(bodies.sums), 1));
        }
        if let Some(schedules) = self.flow.as_ref().and_then(|flow| flow.schedules()) {
            words.push(("emitters", Words::Plain(schedules), 1));
        }
        if let Some(probes) = &self.probes {
            let [accounts, counts] = probes.memory();
            words.push(("probe_accounts", Words::Plain(accounts), 1));
            words.push(("probe_counts", Words::Plain(counts), 1));
        }
        words
    }
}

/// A buffer, read and written as 32-bit words.
#[derive(Clone, Copy)]
enum Words {
    Plain(Buffer<u32>),
    State(Buffer<crate::state::StepState>),
}

impl Words {
    fn words(self) -> usize {
        match self {
            Self::Plain(buffer) => buffer.len() as usize,
            Self::State(_) => size_of::<crate::state::StepState>() / 4,
        }
    }

    async fn fetch(self, executor: &mut Executor) -> Result<Vec<u32>, SimulationError> {
        Ok(match self {
            Self::Plain(buffer) => executor.fetch(buffer).await?,
            Self::State(buffer) => bytemuck::cast_slice(&executor.fetch(buffer).await?).to_vec(),
        })
    }

    fn write(self, executor: &mut Executor, words: &[u32]) -> Result<(), SimulationError> {
        match self {
            Self::Plain(buffer) => upload(executor, buffer, words),
            Self::State(buffer) => upload(executor, buffer, words),
        }
    }
}

/// Writes numbers into a buffer, whose elements consist of several numbers each.
fn upload<T: GpuElement, N: NpyElement>(
    executor: &mut Executor,
    buffer: Buffer<T>,
    numbers: &[N],
) -> Result<(), SimulationError> {
    let elements: Vec<T> = bytemuck::cast_slice::<N, u8>(numbers)
        .chunks_exact(size_of::<T>())
        .map(bytemuck::pod_read_unaligned)
        .collect();
    Ok(executor.write(buffer, &elements)?)
}

impl From<CheckpointError> for SimulationError {
    fn from(error: CheckpointError) -> Self {
        Self::Checkpoint(Box::new(error))
    }
}
