//! Emitters and sinks.

use glam::{DVec3, DVec4, UVec3, Vec2, Vec3, Vec4, Vec4Swizzles};
use splashdown::flow::{EmissionSchedule, Nozzle, SinkShape};
use splashdown::state::{DEAD_DRAINED, DEAD_UNBORN, StepCounters};
use splashdown_gpu::DispatchSize;

use super::harness::{Case, Data, close, exact, wide};
use super::sort_cases::pass;
use super::world::{SPACING, World, params};

pub fn cases() -> Vec<Case> {
    vec![plan(), emit(), drive(), drain()]
}

/// Two emitters that overlap the cloud, a disc and a rectangle; one before its start, one after its end.
fn nozzles() -> Vec<Nozzle> {
    let direction = Vec3::new(0.6, 0.0, 0.8);
    let disc = Nozzle {
        back: Vec3::new(-0.111, 0.207, 0.313),
        speed: 1.7,
        direction,
        length: 0.151,
        across: Vec3::new(0.8, 0.0, -0.6),
        start: 0.0,
        up: Vec3::new(0.0, 1.0, 0.0),
        end: 9.0,
        half_across: 0.13,
        half_up: 0.13,
        first_point: 0,
        points: 12,
        most: 1000,
        disc: 1,
        interval: 0.97 * SPACING,
        wobble: 0.0,
        share_across: 0.7,
        share_up: 0.3,
        stretching: 14.0,
        submerged_at: 9.0,
    };
    let rectangle = Nozzle {
        back: Vec3::new(0.13, 0.31, 0.47),
        half_across: 0.09,
        half_up: 0.05,
        first_point: 12,
        points: 8,
        disc: 0,
        speed: 0.9,
        wobble: 0.11 * SPACING,
        // More than the limit.
        share_across: -1.4,
        ..disc
    };
    let late = Nozzle { start: 5.0, first_point: 20, points: 3, ..disc };
    let over = Nozzle { end: 0.5, first_point: 23, points: 2, ..rectangle };
    vec![disc, rectangle, late, over]
}

fn points() -> Vec<Vec4> {
    let place =
        |i: u8| Vec4::new(f32::from(i % 4) - 1.5, f32::from(i / 4 % 3) - 1.0, 0.07 * f32::from(i), 0.0);
    (0..25).map(|i| 0.9 * SPACING * place(i)).collect()
}

fn plan() -> Case {
    let mut world = World::new(params(2.0), 500);
    let due = nozzles();
    // Room for the first and the second, but not for another one like the first; the last has reached its limit.
    let mut nozzles = due.clone();
    nozzles.extend([due[0], Nozzle { most: 100, ..due[1] }]);
    let active = world.active() as u32;
    world.params.particle_count = active + 25;
    let dt = world.state.dt;
    let phases = [1.0, 0.999_9, 1.0, 1.0, 1.0, 1.0].map(|layers| layers * due[0].interval);
    let emitted = [24, 0, 0, 0, 5, 95];
    let mut plans = vec![0; 6 * EmissionSchedule::WORDS + 1];
    for (k, plan) in plans.chunks_exact_mut(EmissionSchedule::WORDS).enumerate() {
        plan[EmissionSchedule::PHASE] = phases[k].to_bits();
        plan[EmissionSchedule::EMITTED] = emitted[k];
        plan[EmissionSchedule::LAYER] = 77;
        plan[EmissionSchedule::COUNTED] = 5 + k as u32;
        plan[EmissionSchedule::BESIDE] = 88;
    }
    plans[6 * EmissionSchedule::WORDS] = 4000;
    let mut expected = plans.clone();
    for plan in expected.chunks_exact_mut(EmissionSchedule::WORDS) {
        plan[EmissionSchedule::LAYER] = 0;
        plan[EmissionSchedule::BESIDE] = plan[EmissionSchedule::COUNTED];
        plan[EmissionSchedule::COUNTED] = 0;
    }
    let mut set = |k: usize, word: usize, value: u32| expected[k * EmissionSchedule::WORDS + word] = value;
    let rest = |k: usize| {
        (f64::from(phases[k]) + f64::from(due[k % 4].speed * dt) - f64::from(due[0].interval)) as f32
    };
    for (k, slot, id) in [(0, active, 4000), (1, active + 12, 4012)] {
        set(k, EmissionSchedule::PHASE, rest(k).to_bits());
        set(k, EmissionSchedule::DISTANCE, rest(k).to_bits());
        set(k, EmissionSchedule::LAYER, due[k].points);
        set(k, EmissionSchedule::SLOT, slot);
        set(k, EmissionSchedule::ID, id);
    }
    set(4, EmissionSchedule::PHASE, rest(0).to_bits());
    set(4, EmissionSchedule::REFUSED, 12);
    expected[6 * EmissionSchedule::WORDS] = 4020;
    let same = |a: &[u32], b: &[u32]| {
        for (k, (a, b)) in a.iter().zip(b).enumerate() {
            let is_float = [EmissionSchedule::PHASE, EmissionSchedule::DISTANCE]
                .contains(&(k % EmissionSchedule::WORDS))
                && k < 6 * EmissionSchedule::WORDS;
            let near = (f32::from_bits(*a) - f32::from_bits(*b)).abs() <= 1e-7 * SPACING.max(1.0);
            if !(a == b || is_float && near) {
                return Err(format!("plans: word {k} is {a:#x} and {b:#x}"));
            }
        }
        Ok(())
    };
    Case {
        pass: pass("flow.emission_schedule"),
        name: "due, late, over, without room, at its limit".into(),
        size: DispatchSize::Groups(1),
        input: vec![
            Data::Params(world.params),
            Data::Grid(world.grid),
            Data::State(world.state),
            Data::U32(world.cell_start.clone()),
            Data::Nozzles(nozzles),
            Data::U32(plans),
        ],
        compare: Box::new(move |a, b| same(a[0].words(), b[0].words())),
        oracle: Box::new(move |out| same(out[0].words(), &expected)),
        control: |input| {
            let Data::State(state) = &mut input[2] else { panic!("no state") };
            state.dt *= 1.001;
        },
    }
}

fn emit() -> Case {
    let world = World::new(params(2.0), 1500);
    let (nozzles, points) = (nozzles(), points());
    let active = world.active();
    let mut plans = vec![0; 4 * EmissionSchedule::WORDS + 1];
    for (k, slot, id) in [(0, active, 9000), (1, active + 12, 9012)] {
        let plan = &mut plans[k * EmissionSchedule::WORDS..];
        plan[EmissionSchedule::EMITTED] = 5;
        plan[EmissionSchedule::LAYER] = nozzles[k].points;
        plan[EmissionSchedule::SLOT] = slot as u32;
        plan[EmissionSchedule::ID] = id;
        plan[EmissionSchedule::DISTANCE] = 0.004_f32.to_bits();
    }
    // After the active particles: dead ones and unused slots.
    let n = active + 25;
    let mut positions = world.positions.clone();
    positions.resize(n, Vec4::new(0.0, 0.0, 0.0, DEAD_UNBORN));
    let mut velocities = world.velocities.clone();
    velocities.resize(n, Vec4::ZERO);
    let mut ids = world.ids.clone();
    ids.resize(n, 7);
    let mut densities = world.densities.clone();
    densities.resize(n, Vec2::ZERO);

    let mut expected = (plans.clone(), positions.clone(), velocities.clone(), ids.clone(), densities.clone());
    let mut blocked = 0;
    for (k, nozzle) in nozzles[..2].iter().enumerate() {
        for place in 0..nozzle.points as usize {
            let id = if k == 0 { 9000 } else { 9012 } + place as u32;
            let beside = [1, 2].map(|power| {
                // The sequence R2, in 24 bits.
                let step = (4_294_967_296.0 / 1.324_717_957_244_746_f64.powi(power)).round();
                let fraction = (f64::from(id) * step / 4_294_967_296.0).fract();
                f64::from(nozzle.wobble) * (2.0 * fraction - 1.0)
            });
            let mut q = points[nozzle.first_point as usize + place].as_dvec4();
            q += DVec4::new(beside[0], beside[1], 0.0, 0.0);
            let x = nozzle.back.as_dvec3()
                + (0.004_f32 as f64 + q.z) * nozzle.direction.as_dvec3()
                + q.x * nozzle.across.as_dvec3()
                + q.y * nozzle.up.as_dvec3();
            let near = |p: &Vec4| p.w == 0.0 && p.xyz().as_dvec3().distance(x) < 0.7 * f64::from(SPACING);
            if positions.iter().any(near) {
                expected.0[k * EmissionSchedule::WORDS + EmissionSchedule::BLOCKED] += 1;
                blocked += 1;
                continue;
            }
            let slot = active + if k == 0 { 0 } else { 12 } + place;
            expected.0[k * EmissionSchedule::WORDS + EmissionSchedule::EMITTED] += 1;
            expected.1[slot] = x.as_vec3().extend(0.0);
            expected.2[slot] = (nozzle.speed * nozzle.direction).extend(1000.0);
            expected.3[slot] = 9000 + (slot - active) as u32;
            expected.4[slot] = Vec2::new(1000.0, 0.0);
        }
    }
    assert!((3..18).contains(&blocked), "{blocked} of 20 blocked: the case must contain both");
    let near = |what: &str, a: &Data, b: &Data| {
        let b = wide(b.floats());
        close(what, a.floats(), &b, &vec![1e-6; b.len()])
    };
    let same = move |a: &[Data], b: &[Data]| {
        exact("plans", a[0].words(), b[0].words())?;
        near("positions", &a[1], &b[1])?;
        near("velocities", &a[2], &b[2])?;
        exact("ids", a[3].words(), b[3].words())?;
        near("densities", &a[4], &b[4])
    };
    let expected = [
        Data::U32(expected.0),
        Data::Vec4(expected.1),
        Data::Vec4(expected.2),
        Data::U32(expected.3),
        Data::Vec2(expected.4),
    ];
    Case {
        pass: pass("flow.emit"),
        name: "two layers, some positions occupied".into(),
        size: DispatchSize::Items(points.len() as u32),
        input: vec![
            Data::Params(world.params),
            Data::Grid(world.grid),
            Data::U32(world.cell_start.clone()),
            Data::Nozzles(nozzles),
            Data::Vec4(points),
            Data::U32(plans),
            Data::Vec4(positions),
            Data::Vec4(velocities),
            Data::U32(ids),
            Data::Vec2(densities),
        ],
        compare: Box::new(same),
        oracle: Box::new(move |out| same(out, &expected)),
        control: |input| {
            let Data::Nozzles(nozzles) = &mut input[3] else { panic!("no nozzles") };
            nozzles[1].back.x += 1e-5;
        },
    }
}

fn drive() -> Case {
    let mut world = World::new(params(2.0), 1500);
    // Long enough that some particles leave.
    world.state.dt = 0.03;
    let nozzles = nozzles();
    let mut plans = vec![0; 5 * EmissionSchedule::WORDS + 1];
    // The last is inactive only because of its limit.
    let mut all = nozzles.clone();
    all.push(Nozzle { back: Vec3::new(0.0, 0.1, 0.2), most: 10, points: 5, first_point: 25, ..nozzles[0] });
    plans[4 * EmissionSchedule::WORDS + EmissionSchedule::EMITTED] = 6;
    // The outlet of the disc is a third under water, that of the last, which is off, twice.
    plans[EmissionSchedule::BESIDE] = 3;
    plans[EmissionSchedule::COUNTED] = 2;
    plans[4 * EmissionSchedule::WORDS + EmissionSchedule::BESIDE] = 18;
    let accelerations: Vec<Vec4> = (0..world.len()).map(|i| world.normals[i] * 3.0).collect();
    let (mut expected, mut expected_plans) = (accelerations.clone(), plans.clone());
    let (mut driven, mut leaving) = (0, [0; 2]);
    for (i, a) in expected.iter_mut().enumerate().take(world.active()) {
        let local = |nozzle: &Nozzle| {
            let o: DVec3 = (world.positions[i].xyz() - nozzle.back).as_dvec3();
            [nozzle.across, nozzle.up, nozzle.direction].map(|axis| o.dot(axis.as_dvec3()))
        };
        let within = |nozzle: &Nozzle, margin: f64| {
            let [a, b, _] = local(nozzle);
            let (h, up) = (f64::from(nozzle.half_across) + margin, f64::from(nozzle.half_up) + margin);
            if nozzle.disc == 1 { a.hypot(b) <= h } else { a.abs() <= h && b.abs() <= up }
        };
        let holds = |nozzle: &Nozzle| {
            let along = local(nozzle)[2];
            within(nozzle, 0.0) && along >= -0.25 * f64::from(SPACING) && along <= f64::from(nozzle.length)
        };
        if let Some(k) = (0..2).find(|&k| holds(&nozzles[k])) {
            let nozzle = &nozzles[k];
            let [across, up, along] = local(nozzle);
            let mut velocity = f64::from(nozzle.speed) * nozzle.direction.as_dvec3();
            if along + f64::from(nozzle.speed * world.state.dt) > f64::from(nozzle.length) {
                let in_air = if k == 0 { 2.0 / 3.0 } else { 1.0 };
                let along_gravity = world.params.gravity.as_dvec3().dot(nozzle.direction.as_dvec3());
                let rate = |share: f32, half: f32| {
                    let most = f64::from(0.5 * nozzle.speed / half);
                    in_air * (f64::from(share * nozzle.stretching) * along_gravity).clamp(-most, most)
                };
                velocity -= rate(nozzle.share_across, nozzle.half_across) * across * nozzle.across.as_dvec3();
                velocity -= rate(nozzle.share_up, nozzle.half_up) * up * nozzle.up.as_dvec3();
                leaving[k] += 1;
            }
            let change = velocity.as_vec3() - world.velocities[i].xyz();
            // The fourth component keeps the particle from being shifted.
            *a = (change / world.state.dt).extend(1.0);
            driven += 1;
            continue;
        }
        for (k, nozzle) in all.iter().enumerate() {
            let along = local(nozzle)[2];
            let is_along = along >= 0.0 && along <= f64::from(nozzle.length);
            if is_along && within(nozzle, 1.5 * f64::from(SPACING)) && !within(nozzle, 0.0) {
                expected_plans[k * EmissionSchedule::WORDS + EmissionSchedule::COUNTED] += 1;
            }
        }
    }
    assert!(driven > 20 && driven < world.active() / 2, "{driven}");
    assert!(leaving.iter().all(|&count| count > 1 && count < driven / 2), "{leaving:?} of {driven}");
    let counted = |k: usize| expected_plans[k * EmissionSchedule::WORDS + EmissionSchedule::COUNTED];
    assert!(counted(0) > 10 && counted(1) > 10, "{expected_plans:?}");
    let same = |a: &[Data], b: &[Data]| {
        exact("schedules", a[0].words(), b[0].words())?;
        let b = wide(b[1].floats());
        let tolerance: Vec<f64> = b.iter().map(|b| 2e-6 * b.abs() + 1e-3).collect();
        close("accelerations", a[1].floats(), &b, &tolerance)
    };
    let expected = [Data::U32(expected_plans), Data::Vec4(expected)];
    Case {
        pass: pass("flow.inflow_constraint"),
        name: "a disc and a rectangle on, others off".into(),
        size: DispatchSize::Items(world.len() as u32),
        input: vec![
            Data::Params(world.params),
            Data::Grid(world.grid),
            Data::State(world.state),
            Data::U32(world.cell_start.clone()),
            Data::Nozzles(all),
            Data::U32(plans),
            Data::Vec4(world.positions.clone()),
            Data::Vec4(world.velocities.clone()),
            Data::Vec4(accelerations),
        ],
        compare: Box::new(same),
        oracle: Box::new(move |out| same(out, &expected)),
        control: |input| {
            let Data::Nozzles(nozzles) = &mut input[4] else { panic!("no nozzles") };
            nozzles[1].speed *= 1.0001;
        },
    }
}

fn drain() -> Case {
    let world = World::new(params(2.0), 1500);
    let none = SinkShape {
        low: Vec3::new(-0.211, 0.053, 0.157),
        kind: SinkShape::BOX,
        high: Vec3::new(-0.083, 0.167, 0.291),
        cell_size: 0.0,
        nodes: UVec3::ZERO,
        first_node: 0,
    };
    let normal = Vec3::new(0.6, 0.8, 0.0);
    let below =
        SinkShape { kind: SinkShape::BELOW, low: Vec3::new(-0.203, 0.0511, 0.0), high: normal, ..none };
    // A ball of a tenth of a metre, after five unused words.
    let (center, nodes, cell_size) = (Vec3::new(0.1, 0.3, 0.45), UVec3::new(12, 13, 14), 0.02);
    let low = center - 0.12;
    let ball = SinkShape {
        kind: SinkShape::MAP,
        low,
        high: low + (nodes - UVec3::ONE).as_vec3() * cell_size,
        cell_size,
        nodes,
        first_node: 5,
    };
    let mut maps = vec![-1.0; 5];
    for k in 0..nodes.element_product() {
        let node = UVec3::new(k % nodes.x, k / nodes.x % nodes.y, k / (nodes.x * nodes.y));
        maps.push((low + node.as_vec3() * cell_size).distance(center) - 0.1);
    }
    let interpolated = |maps: &[f32], x: Vec3| -> f64 {
        let at = (x.as_dvec3() - low.as_dvec3()) / f64::from(cell_size);
        let c = at.floor();
        (0..8u32).fold(0.0, |sum, corner| {
            let corner = UVec3::new(corner & 1, corner >> 1 & 1, corner >> 2);
            let f = at - c - corner.as_dvec3();
            let node = c.as_uvec3() + corner;
            let value = maps[5 + ((node.z * nodes.y + node.y) * nodes.x + node.x) as usize];
            sum + f64::from(value) * (1.0 - f.abs()).element_product()
        })
    };
    let mut expected = world.positions.clone();
    let mut by = [0; 3];
    for p in &mut expected[..world.active()] {
        let x = p.xyz();
        let within = |drain: &SinkShape| x.cmpge(drain.low).all() && x.cmplt(drain.high).all();
        let takes =
            [within(&none), (x - below.low).dot(normal) < 0.0, within(&ball) && interpolated(&maps, x) < 0.0];
        if let Some(k) = takes.iter().position(|&takes| takes) {
            by[k] += 1;
            p.w = DEAD_DRAINED;
        }
    }
    assert!(by.iter().all(|&n| n > 3), "{by:?}");
    let mut counters = vec![1, 2, 3, 4, 0, 0, 0, 10];
    let before = counters.clone();
    counters[StepCounters::DRAINED] += by.iter().sum::<u32>();
    Case {
        pass: pass("flow.sink"),
        name: "a box, a plane, a ball".into(),
        size: DispatchSize::Items(world.len() as u32),
        input: vec![
            Data::Grid(world.grid),
            Data::State(world.state),
            Data::U32(world.cell_start.clone()),
            Data::Drains(vec![none, below, ball]),
            Data::F32(maps),
            Data::Vec4(world.positions.clone()),
            Data::U32(before),
        ],
        compare: Box::new(|a, b| {
            exact("positions", a[0].words(), b[0].words())?;
            exact("counters", a[1].words(), b[1].words())
        }),
        oracle: Box::new(move |out| {
            exact("positions", out[0].words(), Data::Vec4(expected.clone()).words())?;
            exact("counters", out[1].words(), &counters)
        }),
        control: |input| {
            let Data::Drains(drains) = &mut input[3] else { panic!("no drains") };
            drains[2].low.x += 0.02;
            drains[2].high.x += 0.02;
        },
    }
}
