//! The targets of a release.

use anyhow::{Context, Result, bail};

use crate::command::{output, program, root};

const LINUX_GNU: &str = "x86_64-unknown-linux-gnu";
const LINUX_MUSL: &str = "x86_64-unknown-linux-musl";

/// One target.
#[derive(Clone, Debug)]
pub struct Target {
    pub triple: String,
    host: String,
}

impl Target {
    /// A target by its triple.
    pub fn new(triple: &str) -> Self {
        Self { triple: triple.to_owned(), host: host().unwrap_or_default() }
    }

    /// True for a static binary: it cannot load a Vulkan driver, so it is built without the window.
    pub fn is_static(&self) -> bool {
        self.triple.ends_with("-musl")
    }

    /// True for Windows.
    pub fn is_windows(&self) -> bool {
        self.triple.contains("-windows-")
    }

    /// True if it is cargo's default target.
    pub fn is_host_triple(&self) -> bool {
        self.triple == self.host
    }

    /// True if its binaries run on this machine.
    pub fn is_host(&self) -> bool {
        self.is_host_triple() || (self.is_static() && self.host == LINUX_GNU)
    }

    /// True if it has a Debian package.
    pub fn has_debian_package(&self) -> bool {
        self.triple.ends_with("-linux-gnu")
    }

    /// Arguments of cargo that select the features.
    pub fn features(&self) -> &'static [&'static str] {
        if self.is_static() { STATIC_FEATURES } else { &[] }
    }

    /// A short description of the binary.
    pub fn contents(&self) -> &'static str {
        if self.is_static() {
            "static, simulates on the CPU: no GPU, pictures or window"
        } else {
            "GPU, pictures and window"
        }
    }

    /// Installs its standard library.
    ///
    /// # Errors
    /// If `rustup` is missing or cannot install it.
    pub fn install(&self) -> Result<()> {
        if self.is_host_triple() {
            return Ok(());
        }
        output(&mut program("rustup", root(), ["target", "add", &self.triple])).map(drop)
    }
}

/// Everything except the window.
const STATIC_FEATURES: &[&str] = &["--no-default-features", "--features", "plot,rigid"];

/// The requested targets, or all that this machine can link.
pub fn chosen(asked: &[String]) -> Result<Vec<Target>> {
    let host = host()?;
    let triples: Vec<&str> = match asked {
        [] if host == LINUX_GNU => vec![LINUX_GNU, LINUX_MUSL],
        [] => vec![&host],
        asked => asked.iter().map(String::as_str).collect(),
    };
    Ok(triples.into_iter().map(Target::new).collect())
}

/// The systems that are only type-checked from this one.
pub fn checked_elsewhere() -> &'static [&'static str] {
    if cfg!(target_os = "linux") { &["x86_64-pc-windows-msvc", "aarch64-apple-darwin"] } else { &[] }
}

/// The triple of this machine.
fn host() -> Result<String> {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let text = output(&mut program(rustc, root(), ["-vV"]))?;
    let line = text.lines().find_map(|line| line.strip_prefix("host: "));
    match line.context("`rustc -vV` names no host")? {
        "" => bail!("`rustc -vV` names an empty host"),
        host => Ok(host.to_owned()),
    }
}
