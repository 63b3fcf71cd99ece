//! A manual page from the program's help: one section per command, with the text of `splashdown COMMAND --help`.

use std::path::Path;

use anyhow::Result;

use super::{Release, extras::ask};

/// The page in roff.
pub fn page(binary: &Path, commands: &[String], release: &Release) -> Result<String> {
    let mut page = format!(
        ".TH SPLASHDOWN 1 \"\" \"Splashdown {}\" \"User Commands\"\n\
         .SH NAME\nsplashdown \\- simulate fluids with smoothed-particle hydrodynamics\n\
         .SH SYNOPSIS\n.B splashdown\n.I COMMAND\n[\\fIOPTIONS\\fR]\n\
         .SH DESCRIPTION\n",
        escape(&release.version)
    );
    page += &verbatim(&ask(binary, &["--help"])?);
    for command in commands {
        page += &format!(".SH \"splashdown {}\"\n", escape(command));
        page += &verbatim(&ask(binary, &[command, "--help"])?);
    }
    Ok(page)
}

/// A block of unformatted lines.
fn verbatim(text: &str) -> String {
    let lines: String = text.trim_end().lines().map(|line| line_of_roff(line) + "\n").collect();
    format!(".EX\n{lines}.EE\n")
}

/// Escapes a line. roff would read a line that begins with a dot or an apostrophe as a request.
fn line_of_roff(line: &str) -> String {
    let line = escape(line.trim_end());
    if line.starts_with(['.', '\'']) { format!("\\&{line}") } else { line }
}

/// Escapes backslashes and hyphens, which are special in roff.
fn escape(text: &str) -> String {
    text.replace('\\', "\\e").replace('-', "\\-")
}

#[cfg(test)]
mod tests {
    use super::verbatim;

    #[test]
    fn help_is_escaped_for_roff() {
        assert_eq!(verbatim(".5 a-b\n'x' \\n\n\n"), ".EX\n\\&.5 a\\-b\n\\&'x' \\en\n.EE\n");
    }
}
