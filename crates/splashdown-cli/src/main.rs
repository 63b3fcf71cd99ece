//! The program `splashdown`; its code is the library `splashdown_cli`.

use std::process::ExitCode;

fn main() -> ExitCode {
    silence_drivers();
    ExitCode::from(splashdown_cli::run(std::env::args_os()))
}

/// Mesa prints "error: XDG_RUNTIME_DIR is invalid or not set" when adapters are listed on a machine without a desktop.
/// The message is harmless but looks like an error of this program. Any folder in that variable prevents it.
fn silence_drivers() {
    const VARIABLE: &str = "XDG_RUNTIME_DIR";
    if cfg!(target_os = "linux") && std::env::var_os(VARIABLE).is_none() {
        // SAFETY: `main` calls this first, before any other thread exists that could read the environment.
        unsafe { std::env::set_var(VARIABLE, std::env::temp_dir()) };
    }
}
