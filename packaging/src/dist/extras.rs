//! The parts of an archive that the program generates: its list of commands, its help, and shell completions.

use std::path::Path;

use anyhow::{Result, ensure};

use super::stage::StagedFile;
use crate::command::{output, program, root};

/// Shells and the names of their completion files.
const SHELLS: [(&str, &str); 5] = [
    ("bash", "splashdown.bash"),
    ("zsh", "_splashdown"),
    ("fish", "splashdown.fish"),
    ("elvish", "splashdown.elv"),
    ("powershell", "_splashdown.ps1"),
];

/// The output of the program for these arguments.
pub fn ask(binary: &Path, arguments: &[&str]) -> Result<String> {
    output(&mut program(binary, root(), arguments))
}

/// The commands of the program, from its help.
pub fn commands(binary: &Path) -> Result<Vec<String>> {
    let commands = listed(&ask(binary, &["--help"])?);
    ensure!(!commands.is_empty(), "`splashdown --help` lists no commands");
    Ok(commands)
}

/// The first words of the lines below `Commands:`.
fn listed(help: &str) -> Vec<String> {
    let lines = help.lines().skip_while(|line| line.trim() != "Commands:").skip(1);
    lines
        .take_while(|line| !line.trim().is_empty())
        // A command is indented by two spaces, the continuation of its description by more.
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next())
        .filter(|word| *word != "help")
        .map(str::to_owned)
        .collect()
}

/// One completion file for each shell.
pub fn completions(binary: &Path) -> Result<Vec<StagedFile>> {
    let file = |(shell, name): (&str, &str)| -> Result<StagedFile> {
        Ok(StagedFile::new(format!("completions/{name}"), ask(binary, &["completions", shell])?))
    };
    SHELLS.into_iter().map(file).collect()
}

#[cfg(test)]
mod tests {
    use super::listed;

    #[test]
    fn commands_are_read_from_the_help() {
        let help = "About.\n\nUsage: x <COMMAND>\n\nCommands:\n  run    Simulate\n  view   Open a window\n         \
                    to look\n  help   Print this\n\nOptions:\n  -h  Print help\n";
        assert_eq!(listed(help), ["run", "view"]);
        assert_eq!(listed("no list"), Vec::<String>::new());
    }
}
