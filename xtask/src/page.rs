//! Tests the web page in a real browser.

use std::{fs, thread};

use anyhow::{Result, ensure};

use crate::layers::Outcome;
use crate::process::{self, command, say};
use crate::{serve, setup, web};

/// Names under which Chromium is installed.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Builds the page and operates it like a user; skipped only if there is no browser and none can be installed.
/// `published` selects the optimized page, which takes minutes to build; otherwise a quick build is tested.
pub fn test(published: bool) -> Result<Outcome> {
    let mut browser = browser();
    let missing = |browser: Option<&str>| browser.is_none() || !process::exists("npm", "--version");
    if missing(browser) && setup::can_install() {
        let packages = packages(browser.is_some(), process::exists("npm", "--version"));
        say(format!("Installing {} (apt-get) ...", packages.join(", ")));
        if let Err(error) = setup::install(&packages) {
            say(format!("WARNING: the installation failed: {error:#}. Check the network connection."));
        }
        browser = self::browser();
    }
    let Some(browser) = browser.filter(|_| !missing(browser)) else {
        let reason =
            "it needs Chromium, node and npm (Debian and Ubuntu: `apt-get install chromium nodejs npm`)";
        return Ok(Outcome::Skipped(reason.to_owned()));
    };
    let folder = web::build(if published { web::PUBLISHED } else { web::QUICK })?;
    let npm = if cfg!(windows) { "npm.cmd" } else { "npm" };
    let install =
        ["install", "--prefix", "web/test", "--no-package-lock", "--no-audit", "--no-fund", "--silent"];
    process::run(command(npm).args(install))?;
    let server = serve::Server::new(&folder, 0)?;
    let address = server.address();
    thread::Builder::new().name("server".to_owned()).spawn(move || server.serve())?;
    let picture = process::target().join("page.png");
    let mut test = command("node");
    let folder = process::target().join("page-test");
    fs::create_dir_all(&folder)?;
    let checkpoint = folder.join("small.splashdown");
    test.args(["web/test/page.mjs", &address, &which(browser)?]).arg(&picture).arg(&checkpoint);
    process::run(&mut test)?;
    // The command line resumes from the checkpoint that the page exported.
    let mut run = command(process::build_tested()?);
    run.args(["run", "--resume"]).arg(&checkpoint);
    run.args(["--frames", "20", "--no-pictures", "--quiet", "--out"]).arg(folder.join("out"));
    process::run(&mut run)?;
    say(format!("The screenshot of the page is {}.", picture.display()));
    Ok(Outcome::Passed)
}

/// The packages of what is missing. Debian's npm conflicts with the Node.js of other sources, which contains npm.
fn packages(has_browser: bool, has_npm: bool) -> Vec<&'static str> {
    let browser = if has_browser { &[][..] } else { &["chromium"] };
    let npm = if has_npm { &[][..] } else { &["nodejs", "npm"] };
    [browser, npm].concat()
}

fn browser() -> Option<&'static str> {
    BROWSERS.into_iter().find(|name| process::exists(name, "--version"))
}

/// The path of a program: Playwright does not accept a bare name.
fn which(program: &str) -> Result<String> {
    let output = command("which").arg(program).output()?;
    ensure!(output.status.success(), "`which {program}` finds nothing");
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::packages;

    #[test]
    fn only_missing_packages_are_installed() {
        assert_eq!(packages(false, true), ["chromium"]);
        assert_eq!(packages(true, false), ["nodejs", "npm"]);
        assert_eq!(packages(false, false), ["chromium", "nodejs", "npm"]);
    }
}
