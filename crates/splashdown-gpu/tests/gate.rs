//! The gate: the passes of this crate pass it, and it detects one mutation of every kind of difference.

use std::path::Path;

use glam::{Vec3, Vec4};
use splashdown_gpu::check::{check, check_source};
use splashdown_gpu::{
    Access, Binding, BufferSet, DispatchSize, PassDesc, Recording, WgslModule, bindings, gpu_struct, passes,
    testing,
};

const SOURCES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/src");

#[test]
fn every_pass_agrees_with_its_wgsl_and_every_wgsl_file_has_a_pass() {
    let wrong = testing::gate(Path::new(SOURCES), &passes());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn misplaced_files_and_passes_are_found() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("gate/below");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("orphan.wgsl"), "fn orphan() {}").unwrap();
    let first = passes()[0];
    std::fs::write(folder.join("renamed.wgsl"), first.wgsl).unwrap();
    let forgotten = "pub static FORGOTTEN: PassDesc = PassDesc { label: \"forgotten\", ..OTHER };";
    std::fs::write(folder.join("mod.rs"), forgotten).unwrap();
    let mut wrong = testing::gate(folder.parent().unwrap(), &[first, first]);
    wrong.sort();
    wrong.dedup();
    assert_eq!(wrong.len(), 4, "{wrong:?}");
    let has = |parts: [&str; 2]| wrong.iter().any(|line| parts.iter().all(|part| line.contains(part)));
    assert!(has(["two passes have the label", first.label]), "{wrong:?}");
    assert!(has(["orphan.wgsl", "no pass uses it"]), "{wrong:?}");
    assert!(has(["renamed.wgsl", "not `renamed`"]), "{wrong:?}");
    assert!(has(["mod.rs", "`passes()` lacks FORGOTTEN (\"forgotten\")"]), "{wrong:?}");
}

gpu_struct! {
    /// Mirrors `Sim` in `WGSL`.
    struct Sim {
        support_radius: f32,
        particle_mass: f32,
        particle_count: u32,
        cell_count: u32,
        domain_min: Vec3,
        dt: f32,
    }
}

const WGSL: &str = "\
#import test/square
struct Sim {
    support_radius: f32,
    particle_mass: f32,
    particle_count: u32,
    cell_count: u32,
    domain_min: vec3<f32>,
    dt: f32,
}
#bindings

override FACTOR: f32 = 1.0;

@compute @workgroup_size(64)
fn density(@builtin(global_invocation_id) gid: vec3<u32>) {
    let i = gid.x;
    if (i >= sim.particle_count) {
        return;
    }
    atomicAdd(&counts[cell_start[i]], 1u);
    var rho = 0.0;
    rho += FACTOR * square(positions[i].x);
    densities[i] = rho;
}
";

bindings! {
    struct Bindings {
        sim: uniform Sim,
        positions: read [Vec4],
        cell_start: read [u32],
        densities: write [f32],
        counts: atomic [u32],
    }
}

const SQUARE: WgslModule =
    WgslModule { name: "test/square", source: "fn square(x: f32) -> f32 { return x * x; }" };

const PASS: PassDesc = PassDesc {
    label: "test.density",
    wgsl: WGSL,
    imports: &[SQUARE],
    entry: "density",
    workgroup_size: [64, 1, 1],
    constants: &[("FACTOR", 2.0)],
    bindings: Bindings::LIST,
    cpu: |_, slots| {
        let Bindings { .. } = slots.into();
    },
};

#[test]
fn the_unmutated_pass_is_accepted() {
    check(&PASS).unwrap();
}

/// A description, the replaced texts with their replacements, and a part of the message.
type Mutation = (&'static str, &'static [(&'static str, &'static str)], &'static str);

const MUTATIONS: &[Mutation] = &[
    (
        "swapped members",
        &[("support_radius: f32,\n    particle_mass: f32", "particle_mass: f32,\n    support_radius: f32")],
        "struct Sim",
    ),
    (
        "a vec3 moved up, which changes the padding",
        &[
            ("    domain_min: vec3<f32>,\n", ""),
            ("struct Sim {\n", "struct Sim {\n    domain_min: vec3<f32>,\n"),
        ],
        "struct Sim",
    ),
    ("a member's scalar", &[("cell_count: u32", "cell_count: f32")], "4 bytes of f32 at 12"),
    ("a member's size", &[("dt: f32", "dt: vec2<f32>")], "bytes"),
    ("an additional member", &[("dt: f32,", "dt: f32,\n    exponent: f32,")], "48 bytes"),
    ("another struct with the same members", &[("Sim", "World")], "World in WGSL, Sim in Rust"),
    ("read becomes read_write", &[("read> cell_start", "read_write> cell_start")], "ReadWrite in WGSL"),
    ("read_write becomes read", &[("densities[i] = rho;", ""), ("read_write> d", "read> d")], "Read in WGSL"),
    ("uniform becomes storage", &[("var<uniform> sim", "var<storage, read> sim")], "Uniform in Rust"),
    ("workgroup size", &[("@workgroup_size(64)", "@workgroup_size(128)")], "workgroup [128, 1, 1]"),
    (
        "element type of the same size",
        &[("positions: array<vec4<f32>>", "positions: array<vec3<f32>>")],
        "vec3<f32> in WGSL",
    ),
    (
        "element width",
        &[("densities: array<f32>", "densities: array<vec2<f32>>"), ("= rho;", "= vec2(rho);")],
        "vec2<f32> in WGSL",
    ),
    ("element kind", &[("cell_start: array<u32>", "cell_start: array<i32>")], "i32 in WGSL"),
    ("renamed binding", &[("cell_start", "cell_begin")], "`cell_begin` in WGSL"),
    (
        "swapped bindings",
        &[("binding(1)", "binding(9)"), ("binding(2)", "binding(1)"), ("binding(9)", "binding(2)")],
        "binding",
    ),
    ("a binding that Rust does not declare", &[("binding(4)", "binding(5)")], "which Rust does not declare"),
    ("another group", &[("group(0) @binding(3)", "group(1) @binding(3)")], "group 1"),
    (
        "missing binding",
        &[
            ("@group(0) @binding(4) var<storage, read_write> counts: array<atomic<u32>>;\n", ""),
            ("    atomicAdd(&counts[cell_start[i]], 1u);\n", ""),
        ],
        "4 bindings in WGSL, 5 in Rust",
    ),
    ("renamed entry point", &[("fn density", "fn densities_of")], "entry point"),
    (
        "another stage",
        &[(
            "@compute @workgroup_size(64)\nfn density(@builtin(global_invocation_id) gid: vec3<u32>) {\n    let i = gid.x;",
            "@fragment\nfn density() {\n    let i = 0u;",
        )],
        "compute",
    ),
    (
        "two entry points",
        &[("@compute", "@compute @workgroup_size(64) fn other() {}\n@compute")],
        "2 entry points",
    ),
    (
        "no entry point",
        &[("@compute @workgroup_size(64)\n", ""), ("@builtin(global_invocation_id) ", "")],
        "0 entry points",
    ),
    ("renamed override", &[("FACTOR", "SCALE")], "no `override FACTOR`"),
    (
        "an override without a value",
        &[("override FACTOR", "override EXTRA: f32;\noverride FACTOR"), ("rho = 0.0", "rho = EXTRA")],
        "`override EXTRA` has no value",
    ),
    (
        "a binding that is never used",
        &[("square(positions[i].x)", "1.0")],
        "`positions` is bound and never used",
    ),
    (
        "a writable binding that is never written",
        &[("densities[i] = rho;", "rho += densities[i];")],
        "`densities` is bound as writable and never written",
    ),
    ("type error", &[("var rho = 0.0", "var rho = 0u")], "error"),
    ("syntax error", &[("var rho", "var var rho")], "error"),
];

#[test]
fn every_mutation_of_the_wgsl_is_detected() {
    let source = PASS.source().unwrap();
    for (what, replacements, word) in MUTATIONS {
        let mut mutated = source.clone();
        for (from, to) in *replacements {
            assert!(mutated.contains(from), "{what}: {from:?} is not in the WGSL");
            mutated = mutated.replace(from, to);
        }
        let message = check_source(&PASS, &mutated).expect_err(what);
        assert!(message.contains(word), "{what}: detected for another reason: {message}");
    }
}

#[test]
fn every_mutation_of_the_declaration_is_detected() {
    let many = &const { [Binding::new::<[u32]>("many", Access::Read, false); 9] };
    let mutations = [
        (
            "a constant that the WGSL does not declare",
            PassDesc { constants: &[("FACTR", 2.0)], ..PASS },
            "no `override FACTR`",
        ),
        ("a module that is not given", PassDesc { imports: &[], ..PASS }, "\"test/square\""),
        ("another entry", PassDesc { entry: "densities", ..PASS }, "`densities` in Rust"),
        ("too many storage buffers", PassDesc { bindings: many, ..PASS }, "9 storage buffers"),
        ("no bindings", PassDesc { bindings: &[], ..PASS }, "no definition in scope for identifier"),
    ];
    for (what, pass, word) in mutations {
        let message = check(&pass).expect_err(what);
        assert!(message.contains(word), "{what}: detected for another reason: {message}");
    }
    let source = PASS.source().unwrap();
    let message = check_source(&PassDesc { bindings: &[], ..PASS }, &source).unwrap_err();
    assert!(message.contains("which Rust does not declare"), "{message}");
    let large = PassDesc { workgroup_size: [512, 1, 1], ..PASS };
    let message = check_source(&large, &source.replace("size(64)", "size(512)")).unwrap_err();
    assert!(message.contains("512 invocations"), "{message}");
}

/// Declarations of `PASS` with one binding changed.
mod changed {
    use super::*;

    bindings! {
        pub struct Access {
            sim: uniform Sim,
            positions: read [Vec4],
            cell_start: read [u32],
            densities: read [f32],
            counts: atomic [u32],
        }
    }
    bindings! {
        pub struct NeverWritten {
            sim: uniform Sim,
            positions: read [Vec4],
            cell_start: write [u32],
            densities: write [f32],
            counts: atomic [u32],
        }
    }
    bindings! {
        pub struct NotAtomic {
            sim: uniform Sim,
            positions: read [Vec4],
            cell_start: read [u32],
            densities: write [f32],
            counts: write [u32],
        }
    }
    bindings! {
        pub struct Element {
            sim: uniform Sim,
            positions: read [f32],
            cell_start: read [u32],
            densities: write [f32],
            counts: atomic [u32],
        }
    }
    bindings! {
        pub struct TooMany {
            sim: uniform Sim,
            positions: read [Vec4],
            velocities: read [Vec4],
            cell_start: read [u32],
            densities: write [f32],
            counts: atomic [u32],
        }
    }
    bindings! {
        pub struct Swapped {
            sim: uniform Sim,
            cell_start: read [Vec4],
            positions: read [u32],
            densities: write [f32],
            counts: atomic [u32],
        }
    }
}

#[test]
fn every_mutation_of_the_binding_list_is_detected() {
    let mutations = [
        ("written, declared as read", changed::Access::LIST, "writing to this location is not permitted"),
        (
            "read, declared as writable",
            changed::NeverWritten::LIST,
            "`cell_start` is bound as writable and never",
        ),
        ("atomic, declared as plain", changed::NotAtomic::LIST, "atomic"),
        ("another element", changed::Element::LIST, "error"),
        ("an additional binding", changed::TooMany::LIST, "`velocities` is bound and never used"),
        ("swapped types", changed::Swapped::LIST, "error"),
    ];
    for (what, bindings, word) in mutations {
        let message = check(&PassDesc { bindings, ..PASS }).expect_err(what);
        assert!(message.contains(word), "{what}: detected for another reason: {message}");
    }
}

bindings! {
    struct Difference {
        minuends: read [f32],
        subtrahends: read [f32],
        differences: write [f32],
    }
}

bindings! {
    /// The same with two bindings of the same type swapped.
    struct SwappedDifference {
        subtrahends: read [f32],
        minuends: read [f32],
        differences: write [f32],
    }
}

static SUBTRACT: PassDesc = PassDesc {
    label: "test.subtract",
    wgsl: "\
#bindings
@compute @workgroup_size(1)
fn subtract() {
    differences[0] = minuends[0] - subtrahends[0];
}",
    imports: &[],
    entry: "subtract",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: Difference::LIST,
    cpu: |_, slots| {
        let Difference { minuends, subtrahends, differences } = slots.into();
        differences[0] = minuends[0] - subtrahends[0];
    },
};

/// The WGSL and the executors use the swapped list; the CPU code uses the other one.
static HALF_SWAPPED: PassDesc = PassDesc { bindings: SwappedDifference::LIST, ..SUBTRACT };

static SWAPPED: PassDesc = PassDesc {
    cpu: |_, slots| {
        let SwappedDifference { minuends, subtrahends, differences } = slots.into();
        differences[0] = minuends[0] - subtrahends[0];
    },
    ..HALF_SWAPPED
};

/// Computes 5 - 3 with this pass. The labels are those of the buffers that contain 5 and 3.
fn difference(
    executor: &mut splashdown_gpu::Executor,
    pass: &'static PassDesc,
    labels: [&'static str; 2],
) -> Result<f32, splashdown_gpu::GpuError> {
    let minuends = executor.create_from(labels[0], &[5.0_f32])?;
    let subtrahends = executor.create_from(labels[1], &[3.0_f32])?;
    let differences = executor.create::<f32>("differences", 1)?;
    let mut buffers = BufferSet::new();
    buffers.add("minuends", minuends);
    buffers.add("subtrahends", subtrahends);
    buffers.add("differences", differences);
    let mut recording = Recording::new("difference");
    recording.dispatch(pass, DispatchSize::Groups(1), &buffers);
    executor.run(&recording)?;
    Ok(executor.read(differences)?[0])
}

#[test]
fn swapped_bindings_of_the_same_type_fail_or_have_no_effect() {
    let names = ["minuends", "subtrahends"];
    // Swapped only in the declaration, not in the WGSL: rejected by the gate.
    let message = check_source(&SWAPPED, &SUBTRACT.source().unwrap()).unwrap_err();
    assert!(message.contains("binding 0: `minuends` in WGSL, `subtrahends` in Rust"), "{message}");
    for (name, mut executor) in testing::executors("swapped_bindings_of_the_same_type_fail_or_have_no_effect")
    {
        // Swapped in the binding list that everything refers to by name: no effect.
        for pass in [&SUBTRACT, &SWAPPED] {
            check(pass).unwrap();
            assert_eq!(difference(&mut executor, pass, names).unwrap(), 2.0, "{name}");
        }
        // Swapped where the buffers are created: rejected.
        let error = difference(&mut executor, &SUBTRACT, ["subtrahends", "minuends"]).unwrap_err();
        let expected =
            "pass test.subtract: binding \"minuends\": the set holds buffer \"subtrahends\" under this name";
        assert_eq!(error.to_string(), expected, "{name}");
    }
}

#[test]
#[should_panic(
    expected = "the CPU code views binding \"minuends\", but the pass declares Some(\"subtrahends\")"
)]
fn cpu_code_with_another_list_is_detected() {
    let mut executor = splashdown_gpu::CpuExecutor::new().into();
    let _ = difference(&mut executor, &HALF_SWAPPED, ["minuends", "subtrahends"]);
}

#[test]
fn errors_in_the_wgsl_show_the_line() {
    let wgsl = "#bindings\n@compute @workgroup_size(1)\nfn subtract() {\n    differences[0] = minuend[0];\n}";
    let message = check(&PassDesc { wgsl, ..SUBTRACT }).unwrap_err();
    assert!(message.contains("differences[0] = minuend[0];"), "{message}");
    assert!(message.contains("no definition in scope for identifier: `minuend`"), "{message}");
}
