//! The development commands of this repository: `cargo xtask COMMAND`. The only dependencies are `anyhow` and
//! `serde_json`, so this program builds in a few seconds on a machine that has only Rust.

mod api;
mod bench;
mod blender;
mod build_times;
mod cycles;
mod demo;
mod fuzz;
mod guide;
mod kill;
mod layers;
mod modules;
mod names;
mod package;
mod page;
mod peers;
mod pictures;
mod process;
mod python;
mod report;
mod serve;
mod setup;
mod shaders;
mod storms;
mod suite;
mod supply;
mod test_output;
mod validate;
mod watch;
mod web;
mod wheel;
mod window_picture;

use std::process::ExitCode;

const HELP: &str = "\
Usage: cargo xtask <COMMAND> [OPTIONS]

  demo [ARGUMENTS]  install missing requirements, build, and run the dam break into out/dam-break;
                    ARGUMENTS are passed to `splashdown run` (for example --frames 20)
  test [--fast|--all] [--only LAYER]
                    check format, lints, tests, random scenes, shaders, documentation, the web page and other systems
                    (--fast: up to the shaders; CI=true: also Blender, the optimized page, the command line without features and the
                    Python package; --all: also all code for other systems, and the public API even if its tool has
                    to be installed; --only: the layers with this text in their name, for example `--only page`)
  bench [--quick]   run the benchmarks and write docs/bench.md (--quick: small sizes, writes no file)
  bench --peers [--quick] [--rounds N] [--particles FILE SPACING]
                    compare with SPlisHSPlasH and splashsurf, installed from PyPI, and write docs/peers.md (--rounds: of
                    alternating measurements, 3 by default)
  guide             build the user guide as HTML into target/guide and check its links
  build-times [--jobs N]
                    measure builds of the demo, the whole program and the library into an empty folder
  pictures [SCENE]  render the pictures of the README and the gallery (window: the window)
  cycles [--samples N] [--again] [--dev]
                    draw ten frames with the program and with Cycles, the path tracer of Blender, installed from PyPI,
                    and write the pairs and their differences into the guide (--samples: of Cycles, 64 by default;
                    --again: draw those of Cycles again; --dev: build without optimization)
  blender [--pictures]
                    pack the Blender extension into target/blender and test it in Blender, installed from PyPI
                    (--pictures: also draw those of the guide)
  web [--build] [--port N]
                    build the web page and serve it on localhost (--build: build only)
  wheel [--quick]   build the Python package and test it in an empty environment (--quick: without optimization, window
                    and plots)
  wheel --compare [PARTICLES.npy SPACING]
                    compare the surface reconstruction with pysplashsurf and write docs/python-surface.md
  validate [TEST ...] [--quick] [--variant=NAME] [--page]
                    run the physics cases at three resolutions in release mode and write docs/validation-figures.md;
                    --quick: without the finest; --variant: one column of each case, for example dfsph; --page: only add the figures of the last call
  validate storms, storms [--scenes N] [--seed N] [--first N] [--continuity] [--workers N] [--binary FILE] [--ignore] [--shipped FACTOR]
                    run random scenes, 1,000 by default, and judge their particles by an independent check; a full search
                    writes docs/storms.md (--continuity: only that form of the density; --ignore: with --on-burst ignore; --shipped:
                    the scenes that come with the program, with their spacing multiplied by a factor)
  shaders [--assembly PASS]
                    compile the compute passes for AMD GPUs, which need not be present, and write docs/shaders.md:
                    registers, spills, instructions and predicted times (--assembly: print the machine code of a pass)
  api               check the public API of the library crates and compare it with that of an earlier commit
  deny              check licences, duplicates, sources and known vulnerabilities of the dependencies
  sbom [--out FILE] list the packages in the program as CycloneDX JSON [default: target/splashdown.cdx.json]
  fuzz [TARGET ...] [--minutes N] [--seed N]
                    read random files, an hour per target by default; findings are written to target/fuzz
  package           pack every published crate and build it from its package
  dist [--target TRIPLE] [--no-check]
                    build release archives, a Debian package and checksums in target/dist
  release X.Y.Z [--commit]
                    set the version and date of a release in every file that contains them
  setup             check the requirements of demo and test, and install them where possible
  help              print this text

Environment: CI=true makes a missing Vulkan driver an error and adds tests to `test`.
";

fn main() -> ExitCode {
    if let Some(code) = api::as_rustdoc() {
        return code;
    }
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (command, rest) = match arguments.split_first() {
        Some((command, rest)) => (command.as_str(), rest),
        None => ("help", &[][..]),
    };
    let outcome = match command {
        "demo" => demo::run(rest),
        "test" => suite::run(rest),
        "bench" => bench::run(rest),
        "build-times" => build_times::run(rest),
        "pictures" => pictures::run(rest),
        "cycles" => cycles::run(rest),
        "blender" => blender::run(rest),
        "web" => web::run(rest),
        "wheel" => wheel::run(rest),
        "validate" => validate::run(rest),
        "storms" => storms::run(rest),
        "api" => api::run(rest),
        "package" => package::run(rest),
        "dist" => package::dist(rest),
        "release" => package::release(rest),
        "shaders" => shaders::run(rest),
        "setup" => setup::run(rest),
        "guide" => guide::run(rest),
        "deny" => supply::run(rest),
        "sbom" => supply::sbom(rest),
        "fuzz" => fuzz::run(rest),
        "help" | "--help" | "-h" => {
            process::say(HELP.trim_end());
            Ok(())
        }
        other => {
            eprintln!("error: unknown command `{other}`\n\n{HELP}");
            return ExitCode::from(2);
        }
    };
    process::clean_up();
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
