//! The numbers of `docs/bench.md`, each with the command that gives it.

use std::path::Path;

use anyhow::{Result, bail};

use crate::process::{self, say};
use crate::report::Page;
use crate::{peers, report};

/// A GPU's sizes, where there is one.
const GPU_SIZES: &str = "64K,256K,1M,4M,10M";

/// The word `bench`. The tables come from `splashdown bench`; this only chooses what to measure and writes the
/// headings.
pub fn run(arguments: &[String]) -> Result<()> {
    let quick = match arguments {
        [] => false,
        [flag] if flag == "--quick" => true,
        [flag, rest @ ..] if flag == "--peers" => return peers::run(rest),
        other => bail!("bench takes --quick, --peers or nothing, got {}", other.join(" ")),
    };
    let binary = process::build_release()?;
    let command = if quick { "cargo xtask bench --quick" } else { "cargo xtask bench" };
    let mut page = Page::new("Measured", command, &binary)?;
    page.add(
        "Each table has its command. The scene is a dam break that grows with the number of particles; support of two spacings. *Over \
         the floor* is the time of a step over the least that the device could need for its bytes, its arithmetic and its dispatches, \
         measured in the same process ([performance.md](performance.md) derives them). Beside other programs: [peers.md](peers.md).",
    );
    let one = if quick { "8K" } else { "64K" };
    let few = if quick { "8K,16K" } else { "64K,1M" };
    let threads = threads();
    section(&mut page, &binary, "One step on the CPU, by pass", &["--device", "cpu", "--particles", one])?;
    let growth: &[&str] = if quick {
        &["--device", "cpu", "--particles", "8K,16K,32K", "--no-passes"]
    } else {
        &["--device", "cpu", "--compare", "--no-passes"]
    };
    section(&mut page, &binary, "Cost per particle on the CPU", growth)?;
    section(
        &mut page,
        &binary,
        "Scaling over threads",
        &["--device", "cpu", "--particles", few, "--threads", &threads, "--no-passes"],
    )?;
    section(
        &mut page,
        &binary,
        "The thesis's forces on the CPU",
        &["--device", "cpu", "--solver", "mueller2003", "--particles", one],
    )?;
    section(&mut page, &binary, "On the best GPU", &["--device", "gpu", "--particles", GPU_SIZES])?;
    section(
        &mut page,
        &binary,
        "On software Vulkan, for the record",
        &["--device", "llvmpipe", "--particles", one],
    )?;
    if quick {
        say("\n--quick: docs/bench.md is left as it is.");
        return Ok(());
    }
    page.write("docs/bench.md")
}

/// One thread, and doubling up to all there are.
fn threads() -> String {
    let all = report::threads();
    let doubling =
        std::iter::successors(Some(1), |&threads| Some(2 * threads)).take_while(|&threads| threads < all);
    doubling.chain([all]).map(|threads| threads.to_string()).collect::<Vec<_>>().join(",")
}

/// One table. A device that is not there is said and passed over: the tables that can be made are worth having.
fn section(page: &mut Page, binary: &Path, title: &str, arguments: &[&str]) -> Result<()> {
    let mut command = process::command(binary);
    command.arg("bench").args(arguments).stderr(std::process::Stdio::inherit());
    page.add(&format!("## {title}"));
    page.add(&format!("`{}`", process::line(&command)));
    let output = command.output()?;
    let text = String::from_utf8_lossy(&output.stdout);
    match output.status.code() {
        Some(0) => page.add(&text),
        Some(4) if text.is_empty() => page.add("No such device on this machine."),
        // The largest sizes may not fit; the rows before them are worth having.
        Some(4) => page.add(&format!("{text}\nFurther sizes do not fit this device.")),
        _ => bail!("`{}` failed ({})", process::line(&command), output.status),
    }
    Ok(())
}
