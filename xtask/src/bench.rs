//! `cargo xtask bench`: measures and writes `docs/bench.md`.

use std::path::Path;

use anyhow::{Result, bail};

use crate::process::{self, say};
use crate::report::Page;
use crate::{peers, report};

/// Numbers of particles for a GPU.
const GPU_SIZES: &str = "64K,256K,1M,4M,10M";

/// Runs `cargo xtask bench`. `splashdown bench` prints the tables; this module chooses the cases and writes the headings.
pub fn run(arguments: &[String]) -> Result<()> {
    let quick = match arguments {
        [] => false,
        [flag] if flag == "--quick" => true,
        [flag, rest @ ..] if flag == "--peers" => return peers::run(rest),
        other => bail!("bench takes --quick, --peers or nothing, got {}", other.join(" ")),
    };
    let binary = process::build_release()?;
    let command = if quick { "cargo xtask bench --quick" } else { "cargo xtask bench" };
    let mut page = Page::new("Benchmarks", command, &binary)?;
    page.add(
        "Each section names its command. The scene is a dam break that grows with the number of particles; the support radius is two \
         spacings. *Over the roofline* is the time of a step divided by the minimum time that the device needs for the memory traffic, the \
         arithmetic and the dispatches of a step; these limits are measured in the same process. [Performance](performance.md) \
         explains the results, and [Comparison](peers.md) compares them with other programs.",
    );
    let one = if quick { "8K" } else { "64K" };
    let few = if quick { "8K,16K" } else { "64K,1M" };
    let threads = threads();
    section(&mut page, &binary, "One step on the CPU by pass", &["--device", "cpu", "--particles", one])?;
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
        "Solver mueller2003 on the CPU",
        &["--device", "cpu", "--solver", "mueller2003", "--particles", one],
    )?;
    section(&mut page, &binary, "GPU", &["--device", "gpu", "--particles", GPU_SIZES])?;
    section(&mut page, &binary, "Software Vulkan", &["--device", "llvmpipe", "--particles", one])?;
    if quick {
        say("\n--quick: docs/bench.md is unchanged.");
        return Ok(());
    }
    page.write("docs/bench.md")
}

/// Powers of two up to the number of threads, and that number.
fn threads() -> String {
    let all = report::threads();
    let doubling =
        std::iter::successors(Some(1), |&threads| Some(2 * threads)).take_while(|&threads| threads < all);
    doubling.chain([all]).map(|threads| threads.to_string()).collect::<Vec<_>>().join(",")
}

/// The name of a section for the guide: `GPU` becomes `gpu`.
fn anchor(title: &str) -> String {
    title.to_lowercase().replace(' ', "-")
}

/// One section with its table. A missing device is reported in the section; the other sections are still written.
fn section(page: &mut Page, binary: &Path, title: &str, arguments: &[&str]) -> Result<()> {
    let mut command = process::command(binary);
    command.arg("bench").args(arguments).stderr(std::process::Stdio::inherit());
    page.add(&format!("## {title}"));
    page.add(&format!("`{}`", process::line(&command)));
    let output = command.output()?;
    let text = String::from_utf8_lossy(&output.stdout);
    match output.status.code() {
        Some(0) => page.add_anchored(&anchor(title), &text),
        Some(4) if text.is_empty() => page.add_anchored(&anchor(title), "This machine has no such device."),
        // The rows of the sizes that fit are still written.
        Some(4) => {
            page.add_anchored(&anchor(title), &format!("{text}\nFurther sizes do not fit this device."));
        }
        _ => bail!("`{}` failed ({})", process::line(&command), output.status),
    }
    Ok(())
}
