//! Checks and installs the system requirements besides Rust: a Vulkan driver for the pictures (a software driver
//! suffices) and ffmpeg for the film. Simulating and writing particles and meshes needs neither.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail, ensure};

use crate::process::{self, say};

const PACKAGES: [&str; 3] = ["mesa-vulkan-drivers", "libvulkan1", "ffmpeg"];

/// Packages for testing the window on a machine without a screen.
const SCREEN_PACKAGES: [&str; 10] = [
    "xvfb",
    "xdotool",
    "imagemagick",
    "libxkbcommon-x11-0",
    "libxcb-xkb1",
    "libxcursor1",
    "libxi6",
    "libxrandr2",
    "libx11-xcb1",
    "fonts-dejavu-core",
];

/// The missing requirements.
#[derive(Debug, Default)]
pub struct Missing {
    driver: bool,
    ffmpeg: bool,
}

impl Missing {
    /// Checks the system.
    pub fn find() -> Self {
        Self { driver: !has_vulkan_driver(), ffmpeg: !process::exists("ffmpeg", "-version") }
    }

    fn nothing(&self) -> bool {
        !self.driver && !self.ffmpeg
    }

    fn names(&self) -> String {
        let driver = self.driver.then_some("a Vulkan driver (for pictures and for tests of the GPU code)");
        let ffmpeg = self.ffmpeg.then_some("ffmpeg (for the film)");
        [driver, ffmpeg].into_iter().flatten().collect::<Vec<_>>().join(" and ")
    }
}

/// The command `setup`.
pub fn run(arguments: &[String]) -> Result<()> {
    ensure!(arguments.is_empty(), "setup takes no arguments, got {}", arguments.join(" "));
    ensure_requirements()
}

/// Checks the requirements, installs them where no password is needed, and reports what is still missing. A missing driver
/// is an error only with `CI=true`; otherwise the simulation runs without pictures.
pub fn ensure_requirements() -> Result<()> {
    let mut missing = Missing::find();
    if missing.nothing() {
        say("Requirements: a Vulkan driver and ffmpeg are installed.");
        return Ok(());
    }
    say(format!("Requirements: missing {}.", missing.names()));
    if can_install() {
        say(format!("Installing {} (apt-get) ...", PACKAGES.join(", ")));
        if let Err(error) = install(&PACKAGES) {
            say(format!("WARNING: the installation failed: {error:#}. Check the network connection."));
        }
        missing = Missing::find();
    }
    if missing.nothing() {
        say("Requirements: all are installed now.");
        return Ok(());
    }
    say(format!("WARNING: {} is still missing.", missing.names()));
    say(format!("  To install: {}", advice()));
    if missing.driver && process::is_ci() {
        bail!("CI=true, but no Vulkan driver is installed: the tests of the GPU code cannot run");
    }
    say("  Continuing without it: particles and meshes are still written.");
    Ok(())
}

/// Installs a virtual X server for the test of the window; without one that test is skipped and reports it.
pub fn ensure_screen() {
    let installed = [("Xvfb", "-help"), ("xdotool", "version"), ("import", "-version")];
    if installed.iter().all(|(tool, argument)| process::exists_at_all(tool, argument)) || !can_install() {
        return;
    }
    say(format!("Installing {} (apt-get) ...", SCREEN_PACKAGES.join(", ")));
    if let Err(error) = install(&SCREEN_PACKAGES) {
        say(format!("WARNING: the installation failed: {error:#}. The test of the window will be skipped."));
    }
}

/// Installs the system's OpenGL library, which the SPlisHSPlasH wheel needs.
pub fn ensure_gl() {
    if !cfg!(target_os = "linux") || has_library("libGL.so.1") || !can_install() {
        return;
    }
    say("Installing libgl1 (apt-get) ...");
    if let Err(error) = install(&["libgl1"]) {
        say(format!("WARNING: the installation failed: {error:#}. SPlisHSPlasH may not load."));
    }
}

/// True on Debian or Ubuntu with the right to install packages.
pub fn can_install() -> bool {
    cfg!(target_os = "linux") && is_root() && process::exists("apt-get", "--version")
}

fn is_root() -> bool {
    let output = process::command("id").arg("-u").output();
    output.is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}

/// Installs Debian packages.
pub fn install(packages: &[&str]) -> Result<()> {
    process::run(process::command("apt-get").args(["update", "-qq"]))?;
    let mut install = process::command("apt-get");
    install.env("DEBIAN_FRONTEND", "noninteractive");
    install.args(["install", "-y", "-qq", "--no-install-recommends"]).args(packages);
    // The list of unpacked packages is long and of no use; errors go to stderr.
    install.stdout(std::process::Stdio::null());
    process::run(&mut install)
}

fn advice() -> &'static str {
    if cfg!(target_os = "windows") {
        "install your graphics card's driver; `winget install ffmpeg`"
    } else if cfg!(target_os = "macos") {
        "`brew install ffmpeg` (Metal is part of the system)"
    } else {
        "on Debian and Ubuntu `sudo apt-get install mesa-vulkan-drivers libvulkan1 ffmpeg`, on Fedora `sudo dnf install \
         mesa-vulkan-drivers vulkan-loader ffmpeg-free`, on Arch `sudo pacman -S vulkan-swrast vulkan-icd-loader ffmpeg`; \
         with a graphics card, its own Vulkan driver"
    }
}

/// True if a driver is installed that finds a device: a software driver, or any driver if there is a graphics card.
fn has_vulkan_driver() -> bool {
    if !cfg!(target_os = "linux") {
        return true; // Direct3D 12 and Metal come with the system.
    }
    let manifests = manifests();
    let software =
        |path: &PathBuf| file_name(path).starts_with("lvp_icd") || file_name(path).contains("swiftshader");
    has_loader() && (manifests.iter().any(software) || (!manifests.is_empty() && has_graphics_card()))
}

fn file_name(path: &Path) -> std::borrow::Cow<'_, str> {
    path.file_name().unwrap_or_default().to_string_lossy()
}

/// The driver manifests that Vulkan's loader would read.
fn manifests() -> Vec<PathBuf> {
    for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        if let Some(files) = std::env::var_os(variable) {
            return std::env::split_paths(&files).filter(|file| file.exists()).collect();
        }
    }
    let folders = ["/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d"];
    let entries = folders.iter().filter_map(|folder| std::fs::read_dir(folder).ok()).flatten().flatten();
    entries
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|end| end == "json"))
        .collect()
}

fn has_loader() -> bool {
    has_library("libvulkan.so.1")
        || ["/usr/lib/libvulkan.so.1", "/usr/lib64/libvulkan.so.1"]
            .iter()
            .any(|path| Path::new(path).exists())
}

/// True if the dynamic loader finds this library.
fn has_library(name: &str) -> bool {
    let listed = process::command("ldconfig").arg("-p").output().or_else(|_| {
        // Not on the search path of some systems.
        process::command("/sbin/ldconfig").arg("-p").output()
    });
    listed.is_ok_and(|output| String::from_utf8_lossy(&output.stdout).contains(name))
}

fn has_graphics_card() -> bool {
    let render_node = |entry: std::fs::DirEntry| entry.file_name().to_string_lossy().starts_with("renderD");
    let nodes = std::fs::read_dir("/dev/dri").is_ok_and(|entries| entries.flatten().any(render_node));
    nodes || Path::new("/dev/nvidia0").exists() || Path::new("/dev/dxg").exists()
}
