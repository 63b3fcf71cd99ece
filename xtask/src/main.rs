//! Every habit of this repository as one word: `cargo xtask WORD`. Nothing but the standard library and
//! `anyhow`, so that it builds in a second on a machine that has only Rust.

mod api;
mod bench;
mod build_times;
mod demo;
mod guide;
mod kill;
mod layers;
mod modules;
mod package;
mod page;
mod peers;
mod pictures;
mod process;
mod python;
mod report;
mod serve;
mod setup;
mod suite;
mod test_output;
mod validate;
mod watch;
mod web;

use std::process::ExitCode;

const HELP: &str = "\
Usage: cargo xtask <WORD> [OPTIONS]

  demo [ARGUMENTS]  check or install what is needed, build, and run the dam break into out/dam-break;
                    further arguments go to `splashdown run` (for example --frames 20)
  test [--fast|--all]
                    format, lints, tests, documentation, the web page, other systems (--fast: the first three only;
                    --all, and with CI=true: Blender, the page as it is published, all code on other systems too)
  bench [--quick]   measure and write docs/bench.md (--quick: small sizes only, and nothing is written)
  bench --peers [--quick] [--particles FILE SPACING]
                    measure beside SPlisHSPlasH and splashsurf, installed from PyPI, and write docs/peers.md
  guide             build the user guide as HTML into target/guide and check its links
  build-times [--jobs N]
                    measure first builds of the demo, the whole program and the library into an empty folder
  pictures [SCENE]  make the pictures of the README anew
  web [--build] [--port N]
                    the web page: build it and serve it on localhost (--build: build it only)
  validate [CASE]   the checks against measurements at full resolution, in release mode: figures, plots, one page
  api               compare the public API of the library crates with that of an earlier commit
  package           pack every published crate and build it from its package
  dist [--target TRIPLE] [--no-check]
                    release archives, a Debian package and checksums in target/dist
  release X.Y.Z [--commit]
                    set the version and date of a release in every file that holds them
  setup             check what demo and test need and install it where that is possible
  help              this text

Environment: CI=true makes a missing Vulkan driver an error and `test` run with --all.
";

fn main() -> ExitCode {
    if let Some(code) = api::as_rustdoc() {
        return code;
    }
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (word, rest) = match arguments.split_first() {
        Some((word, rest)) => (word.as_str(), rest),
        None => ("help", &[][..]),
    };
    let outcome = match word {
        "demo" => demo::run(rest),
        "test" => suite::run(rest),
        "bench" => bench::run(rest),
        "build-times" => build_times::run(rest),
        "pictures" => pictures::run(rest),
        "web" => web::run(rest),
        "validate" => validate::run(rest),
        "api" => api::run(rest),
        "package" => package::run(rest),
        "dist" => package::dist(rest),
        "release" => package::release(rest),
        "setup" => setup::run(rest),
        "guide" => guide::run(rest),
        "help" | "--help" | "-h" => {
            process::say(HELP.trim_end());
            Ok(())
        }
        other => {
            eprintln!("error: there is no word `{other}`\n\n{HELP}");
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
