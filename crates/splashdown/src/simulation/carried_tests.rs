//! Tests of the table of carried quantities with two additional rows: a row is sufficient to carry a quantity
//! through steps, output and checkpoints.

use splashdown_gpu::{CpuExecutor, Executor, GpuExecutor, block_on, testing};
use splashdown_io::Particles;

use super::Simulation;
use crate::Scene;
use crate::state::{Carried, DENSITIES, IDS, Kind, POSITIONS, Update, VELOCITIES};

/// A constant scalar.
const TAG: Carried = Carried {
    name: "tags",
    sorted: Some("sorted_tags"),
    kind: Kind::F32,
    update: Update::Constant,
    initial: Some(|start, i| [start.attribute("tag", i, tag(i as u32)).to_bits(), 0, 0, 0]),
    output: |mut particles, values| {
        particles.attributes.push(values.attribute("tag"));
        particles
    },
};

/// A constant vector.
const SPIN: Carried = Carried {
    name: "spins",
    sorted: Some("sorted_spins"),
    kind: Kind::Vec4,
    update: Update::Constant,
    initial: Some(|_, i| [tag(i as u32), 1.0, 2.0, -tag(i as u32)].map(f32::to_bits)),
    output: |mut particles, values| {
        let mut attribute = values.attribute("spin");
        attribute.values = values.scalars(3);
        particles.attributes.push(attribute);
        particles
    },
};

static TABLE: &[Carried] = &[POSITIONS, VELOCITIES, DENSITIES, IDS, TAG, SPIN];

/// The value of the particle with this id.
fn tag(id: u32) -> f32 {
    id as f32 * 0.25 + 3.0
}

fn scene() -> Scene {
    Scene::builder("column", 0.5)
        .domain([0.0; 3], [0.8, 0.5, 0.4])
        .particle_spacing(0.05)
        .block([0.0; 3], [0.3, 0.4, 0.4])
        .build()
        .unwrap()
}

fn start(executor: Executor) -> Simulation {
    let scene = scene();
    let particles = crate::sample::particles(&scene).unwrap();
    block_on(Simulation::with_bodies(&scene, executor, &particles, Vec::new(), TABLE)).unwrap()
}

/// The number of particles whose values do not match their ids.
fn mismatches(particles: &Particles) -> usize {
    let [tags, spins] = &particles.attributes[..] else { panic!("{:?}", particles.attributes) };
    let wrong = |i: usize, id: u32| tags.values[i] != tag(id) || spins.values[i] != -tag(id);
    particles.ids.iter().enumerate().filter(|&(i, &id)| wrong(i, id)).count()
}

#[test]
fn a_quantity_follows_its_particle_through_steps_and_checkpoints() {
    for (name, executor) in
        testing::executors("a_quantity_follows_its_particle_through_steps_and_checkpoints")
    {
        let mut simulation = start(executor);
        assert_eq!(mismatches(&simulation.particles().unwrap()), 0, "{name}: at the start");
        let stats = simulation.advance(0.2).unwrap();
        assert!(stats.steps > 50, "{name}: {stats:?}");
        let particles = simulation.particles().unwrap();
        assert_eq!(mismatches(&particles), 0, "{name}: after {} steps", stats.steps);
        // Control: the order of the particles has changed.
        let ids = simulation.executor.read(simulation.fields.ids).unwrap();
        assert!(!ids.is_sorted(), "{name}");
        // Negative control: swapped values are detected.
        let mut swapped = particles.clone();
        swapped.attributes[0].values.swap(0, 1);
        assert_eq!(mismatches(&swapped), 2, "{name}");

        let checkpoint = simulation.checkpoint(&scene().text).unwrap();
        let again = match simulation.gpu() {
            Some(gpu) => Executor::from(GpuExecutor::new(gpu.clone())),
            None => CpuExecutor::new().into(),
        };
        let mut resumed =
            block_on(Simulation::resume_with_table(&checkpoint, again, &|_, _| {}, TABLE)).unwrap();
        assert_eq!(resumed.particles().unwrap(), particles, "{name}: resumed");
        simulation.advance(0.05).unwrap();
        resumed.advance(0.05).unwrap();
        assert_eq!(resumed.particles().unwrap(), simulation.particles().unwrap(), "{name}: continued");
    }
}

#[test]
fn additional_rows_do_not_change_the_other_quantities() {
    let executor = || Executor::from(CpuExecutor::new());
    let mut plain = Simulation::with_executor(&scene(), executor()).unwrap();
    let mut with_rows = start(executor());
    plain.advance(0.1).unwrap();
    with_rows.advance(0.1).unwrap();
    let mut particles = with_rows.particles().unwrap();
    assert_eq!(particles.attributes.len(), 2);
    particles.attributes.clear();
    assert_eq!(particles, plain.particles().unwrap());
    // A persistent and a sorted array for the scalar (4 bytes) and for the vector (16 bytes).
    let more = with_rows.memory() - plain.memory();
    assert_eq!(more, particles.len() as u64 * 2 * (4 + 16));
}
