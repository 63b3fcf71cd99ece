//! Tests of the table of carried quantities with two additional rows: a row is sufficient to carry a quantity
//! through steps, output and checkpoints.

use splashdown_gpu::{CpuExecutor, Executor, GpuExecutor, block_on, testing};
use splashdown_io::Particles;

use super::Simulation;
use crate::Scene;
use crate::scene::Sort;
use crate::state::{Carried, DENSITIES, IDS, Kind, POSITIONS, Update, VELOCITIES};

/// A constant scalar.
const TAG: Carried = Carried {
    name: "tags",
    sorted: Some("sorted_tags"),
    kind: Kind::F32,
    update: Update::Constant,
    emitted: [EMITTED, 0.0, 0.0, 0.0],
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
    emitted: [0.0, 0.0, 0.0, -EMITTED],
    initial: Some(|_, i| [tag(i as u32), 1.0, 2.0, -tag(i as u32)].map(f32::to_bits)),
    output: |mut particles, values| {
        let mut attribute = values.attribute("spin");
        attribute.values = values.scalars(3);
        particles.attributes.push(attribute);
        particles
    },
};

static TABLE: &[Carried] = &[POSITIONS, VELOCITIES, DENSITIES, IDS, TAG, SPIN];

const _: () = Carried::check(TABLE);

/// The value of emitted particles.
const EMITTED: f32 = -1.0;

/// The value of the particle with this id.
fn tag(id: u32) -> f32 {
    id as f32 * 0.25 + 3.0
}

fn scene() -> Scene {
    Scene::builder("column", 0.5)
        .domain([0.0; 3], [0.8, 0.5, 0.4])
        .particle_spacing(0.05)
        .block([0.0; 3], [0.3, 0.4, 0.4])
        .set("solver.method", "wcsph")
        .build()
        .unwrap()
}

fn start(executor: Executor) -> Simulation {
    start_scene(&scene(), executor)
}

fn start_scene(scene: &Scene, executor: Executor) -> Simulation {
    let mut particles = crate::sample::particles(scene).unwrap();
    crate::sample::start_at_rest(scene, &mut particles, &[]);
    block_on(Simulation::with_bodies(scene, executor, &particles, Vec::new(), TABLE)).unwrap()
}

/// The number of particles whose values do not match their ids.
fn mismatches(particles: &Particles) -> usize {
    mismatches_with_emitters(particles, u32::MAX)
}

/// The number of particles whose values do not match their ids. Particles with ids from `initial` are emitted.
fn mismatches_with_emitters(particles: &Particles, initial: u32) -> usize {
    let [tags, spins] = &particles.attributes[..] else { panic!("{:?}", particles.attributes) };
    let expected = |id: u32| if id < initial { tag(id) } else { EMITTED };
    let wrong = |i: usize, id: u32| tags.values[i] != expected(id) || spins.values[i] != -expected(id);
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
    assert_eq!(more, (2 * particles.len() as u64 + 1) * (4 + 16));
}

#[test]
fn the_bitonic_sort_moves_the_quantities_too() {
    for (name, executor) in testing::executors("the_bitonic_sort_moves_the_quantities_too") {
        let mut scene = scene();
        scene.solver.sort = Sort::Bitonic;
        let mut simulation = start_scene(&scene, executor);
        simulation.advance(0.1).unwrap();
        assert_eq!(mismatches(&simulation.particles().unwrap()), 0, "{name}");
    }
}

#[test]
fn emitted_particles_do_not_inherit_the_quantities_of_removed_ones() {
    let text = "[scene]\nname = \"channel\"\nduration = 1.0\ngravity = [0, 0, 0]\n\
                [domain]\nmin = [0, 0, 0]\nmax = [0.6, 0.4, 0.4]\n\
                [fluid]\nparticle_spacing = 0.025\ninitial_pressure = \"zero\"\n\
                [[fluid.block]]\nposition = [0.2, 0.1, 0.1]\nsize = [0.1, 0.2, 0.2]\nvelocity = [1, 0, 0]\n\
                [[emitter]]\nname = \"inlet\"\nradius = 0.05\nposition = [0.05, 0.2, 0.2]\ndirection = [1, 0, 0]\nspeed = 1.0\n\
                [[sink]]\nname = \"outlet\"\nmin = [0.4, 0, 0]\nmax = [0.6, 0.4, 0.4]\n\
                [surface]\nenabled = false\n[solver]\nmethod = \"wcsph\"\n";
    let scene = Scene::parse(text, "channel.toml").unwrap();
    for (name, executor) in
        testing::executors("emitted_particles_do_not_inherit_the_quantities_of_removed_ones")
    {
        let mut simulation = start_scene(&scene, executor);
        let initial = simulation.particles().unwrap().len() as u32;
        let capacity = simulation.params().particle_count;
        let mut stats = simulation.stats();
        while stats.time < 1.2 {
            stats = simulation.advance(0.05).unwrap();
            let particles = simulation.particles().unwrap();
            assert_eq!(mismatches_with_emitters(&particles, initial), 0, "{name}: at {} s", stats.time);
        }
        // Control: emitted particles use the entries of drained ones.
        assert!(stats.drained > initial / 2, "{name}: {stats:?}");
        assert!(stats.emitted + initial > capacity, "{name}: {stats:?}, capacity {capacity}");
    }
}

#[test]
fn a_body_that_displaces_particles_does_not_shift_the_quantities() {
    let mut scene = scene();
    let mut simulation = start_scene(&scene, CpuExecutor::new().into());
    simulation.advance(0.05).unwrap();
    let before = simulation.particles().unwrap().len();
    let text = "[[body]]\nname = \"cube\"\nmesh = \"cube\"\nscale = 0.15\nposition = [0.15, 0.1, 0.2]\n";
    scene = Scene::parse(&format!("{}\n{text}", scene.text), "column.toml").unwrap();
    let mut rebuilt = simulation.rebuild_with(&scene).unwrap();
    let particles = rebuilt.particles().unwrap();
    assert!(particles.len() < before, "{} of {before}", particles.len());
    // Ids are counted again, but positions and tags remain those of the same particles.
    let old = simulation.particles().unwrap();
    for (x, value) in particles.positions.iter().zip(&particles.attributes[0].values) {
        let i = old.positions.iter().position(|other| other == x).expect("the particle has not moved");
        assert_eq!(*value, old.attributes[0].values[i]);
    }
}
