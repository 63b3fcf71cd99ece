//! Measures the time of a first build: an empty target folder, all crates downloaded.

use std::collections::BTreeSet;
use std::fs;
use std::time::Instant;

use anyhow::{Context, Result, bail, ensure};

use crate::process::{self, cargo, say, target};
use crate::{demo, report};

/// The command `build-times`.
pub fn run(arguments: &[String]) -> Result<()> {
    let jobs = match arguments {
        [] => None,
        [flag, jobs] if flag == "--jobs" => {
            Some(jobs.parse::<usize>().with_context(|| format!("--jobs {jobs:?} is not a number"))?)
        }
        other => bail!("build-times takes --jobs N or nothing, got {}", other.join(" ")),
    };
    let demo = [&["--release", "--package", "splashdown-cli"][..], &demo::BUILD].concat();
    let builds: [(&str, &[&str]); 3] = [
        ("the demo", &demo),
        ("the whole program", &["--release", "--package", "splashdown-cli"]),
        ("the library", &["--package", "splashdown"]),
    ];
    process::run(&mut cargo(["fetch"]))?;
    let mut rows = Vec::new();
    for (name, build) in builds {
        rows.push(format!(
            "| {name} | `cargo build {}` | {} | {:.0} s |",
            build.join(" "),
            crates(build)?,
            seconds(build, jobs)?
        ));
    }
    say(format!("\n{} threads\n", jobs.unwrap_or_else(report::threads)));
    say("| what | command | crates | wall time |\n|---|---|---:|---:|");
    for row in rows {
        say(row);
    }
    Ok(())
}

/// Wall time of a build into an empty folder.
fn seconds(build: &[&str], jobs: Option<usize>) -> Result<f64> {
    let folder = target().join("build-times");
    if folder.exists() {
        fs::remove_dir_all(&folder).with_context(|| format!("cannot empty {}", folder.display()))?;
    }
    let mut command = cargo(["build", "--offline", "--target-dir"]);
    command.arg(&folder).args(build).env_remove("RUSTC_WRAPPER");
    if let Some(jobs) = jobs {
        command.args(["--jobs", &jobs.to_string()]);
    }
    let start = Instant::now();
    process::run(&mut command)?;
    let time = start.elapsed().as_secs_f64();
    fs::remove_dir_all(&folder)?;
    Ok(time)
}

/// Number of crates that a build compiles, including dependencies of build scripts and the workspace's own crates.
fn crates(build: &[&str]) -> Result<usize> {
    let mut tree =
        cargo(["tree", "--offline", "--edges", "normal,build", "--prefix", "none", "--format", "{p}"]);
    tree.args(build.iter().filter(|argument| **argument != "--release"));
    let output = tree.output()?;
    ensure!(output.status.success(), "`{}` failed ({})", process::line(&tree), output.status);
    let text = String::from_utf8_lossy(&output.stdout);
    // `cargo tree` marks a crate that it has already listed with an asterisk.
    let names: BTreeSet<&str> = text.lines().map(|line| line.trim_end_matches(" (*)")).collect();
    Ok(names.iter().filter(|name| !name.is_empty()).count())
}
