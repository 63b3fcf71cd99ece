//! The gate: this crate's passes pass it, and for each thing it claims to catch there is a mutation that it catches.

use std::path::Path;

use glam::{Vec3, Vec4};
use splashdown_gpu::check::{check, check_source};
use splashdown_gpu::{PassDesc, WgslModule, gpu_struct, passes, read, testing, uniform, wgsl, write};

const SOURCES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/src");

#[test]
fn every_pass_agrees_with_its_wgsl_and_every_wgsl_has_a_pass() {
    let wrong = testing::gate(Path::new(SOURCES), &passes());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_file_without_a_pass_and_a_label_given_twice_are_found() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("gate/below");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("orphan.wgsl"), "fn nobody() {}").unwrap();
    let first = passes()[0];
    let wrong = testing::gate(folder.parent().unwrap(), &[first, first]);
    assert_eq!(wrong.len(), 2, "{wrong:?}");
    assert!(wrong[0].contains("two passes"), "{wrong:?}");
    assert!(wrong[1].contains("orphan.wgsl"), "{wrong:?}");
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
@group(0) @binding(0) var<uniform> sim: Sim;
@group(0) @binding(1) var<storage, read> positions: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> cell_start: array<u32>;
@group(0) @binding(3) var<storage, read_write> densities: array<f32>;
@group(0) @binding(4) var<storage, read_write> counts: array<atomic<u32>>;

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

const SQUARE: WgslModule =
    WgslModule { name: "test/square", source: "fn square(x: f32) -> f32 { return x * x; }" };

const PASS: PassDesc = PassDesc {
    label: "test.density",
    wgsl: WGSL,
    imports: &[SQUARE],
    entry: "density",
    workgroup_size: [64, 1, 1],
    constants: &[("FACTOR", 2.0)],
    bindings: &[
        uniform::<Sim>("sim"),
        read::<Vec4>("positions"),
        read::<u32>("cell_start"),
        write::<f32>("densities"),
        write::<u32>("counts"),
    ],
    cpu: |_, _| {},
};

#[test]
fn the_pass_that_is_mutated_below_is_right() {
    check(&PASS).unwrap();
}

/// What it is, the texts replaced with their replacements, and a part of the message.
type Mutation = (&'static str, &'static [(&'static str, &'static str)], &'static str);

const MUTATIONS: &[Mutation] = &[
    (
        "swapped members",
        &[("support_radius: f32,\n    particle_mass: f32", "particle_mass: f32,\n    support_radius: f32")],
        "struct Sim",
    ),
    (
        "a vec3 moved up: the padding trap",
        &[
            ("    domain_min: vec3<f32>,\n", ""),
            ("struct Sim {\n", "struct Sim {\n    domain_min: vec3<f32>,\n"),
        ],
        "struct Sim",
    ),
    ("a member's scalar", &[("cell_count: u32", "cell_count: f32")], "4 bytes of f32 at 12"),
    ("a member's size", &[("dt: f32", "dt: vec2<f32>")], "bytes"),
    ("a member too many", &[("dt: f32,", "dt: f32,\n    exponent: f32,")], "48 bytes"),
    ("another struct of the same members", &[("Sim", "World")], "World in WGSL, Sim in Rust"),
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
    ("a binding Rust lacks", &[("binding(4)", "binding(5)")], "which Rust does not declare"),
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
    ("type error", &[("var rho = 0.0", "var rho = 0u")], "error"),
    ("syntax error", &[("var rho", "var var rho")], "error"),
];

#[test]
fn every_mutation_of_the_wgsl_is_caught() {
    let source = wgsl::expand(WGSL, PASS.imports).unwrap();
    for (what, replacements, word) in MUTATIONS {
        let mut mutated = source.clone();
        for (from, to) in *replacements {
            assert!(mutated.contains(from), "{what}: {from:?} is not there");
            mutated = mutated.replace(from, to);
        }
        let message = check_source(&PASS, &mutated).expect_err(what);
        assert!(message.contains(word), "{what}: caught for another reason: {message}");
    }
}

#[test]
fn every_mutation_of_the_declaration_is_caught() {
    let many = &const { [read::<u32>("many"); 9] };
    let mutations = [
        (
            "a constant the WGSL lacks",
            PassDesc { constants: &[("FACTR", 2.0)], ..PASS },
            "no `override FACTR`",
        ),
        ("a module that is not given", PassDesc { imports: &[], ..PASS }, "\"test/square\""),
        ("another entry", PassDesc { entry: "densities", ..PASS }, "`densities` in Rust"),
        ("too many storage buffers", PassDesc { bindings: many, ..PASS }, "9 storage buffers"),
        ("no bindings", PassDesc { bindings: &[], ..PASS }, "does not declare"),
    ];
    for (what, pass, word) in mutations {
        let message = check(&pass).expect_err(what);
        assert!(message.contains(word), "{what}: caught for another reason: {message}");
    }
    let source = wgsl::expand(WGSL, PASS.imports).unwrap();
    let large = PassDesc { workgroup_size: [512, 1, 1], ..PASS };
    let message = check_source(&large, &source.replace("size(64)", "size(512)")).unwrap_err();
    assert!(message.contains("512 invocations"), "{message}");
}
