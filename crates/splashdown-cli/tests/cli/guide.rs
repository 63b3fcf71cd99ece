//! Checks that the program accepts the commands in the README and the user guide, and that the options, formats and
//! exit codes in the guide equal those in the help.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use crate::place::{Outcome, Place, splashdown, stderr, stdout};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The README and the pages of the guide.
fn pages() -> Result<Vec<(PathBuf, String)>, Box<dyn Error>> {
    let mut pages = vec![repository().join("README.md")];
    for entry in fs::read_dir(repository().join("docs/guide/src"))? {
        pages.extend(Some(entry?.path()).filter(|path| path.extension().is_some_and(|end| end == "md")));
    }
    pages.into_iter().map(|path| Ok((path.clone(), fs::read_to_string(&path)?))).collect()
}

fn page(name: &str) -> Result<String, Box<dyn Error>> {
    Ok(fs::read_to_string(repository().join("docs/guide/src").join(name))?)
}

/// The arguments of a shell line that calls the program. Quotes are removed. A comment, a pipe or a redirection ends
/// the arguments.
fn arguments(line: &str) -> Option<Vec<String>> {
    let rest = line.trim().strip_prefix("splashdown ")?;
    let mut words = vec![String::new()];
    let mut quote = None;
    for letter in rest.chars() {
        match (quote, letter) {
            (None, '#' | '|' | '>') => break,
            (None, '\'' | '"') => quote = Some(letter),
            (Some(open), _) if letter == open => quote = None,
            (None, ' ') => words.push(String::new()),
            _ => words.last_mut()?.push(letter),
        }
    }
    words.retain(|word| !word.is_empty());
    Some(words)
}

/// Commands in the shell blocks of a text.
fn commands(text: &str) -> Vec<Vec<String>> {
    let mut is_shell = false;
    let mut found = Vec::new();
    for line in text.lines() {
        match line.trim() {
            "```sh" => is_shell = true,
            "```" => is_shell = false,
            _ if is_shell => found.extend(arguments(line)),
            _ => {}
        }
    }
    found
}

/// Whether the program accepts the arguments. It parses those before `--help`, so that a wrong option is an error, and
/// executes nothing.
fn is_accepted(command: &[String]) -> Result<bool, Box<dyn Error>> {
    let words: Vec<&str> = command.iter().map(String::as_str).chain(["--help"]).collect();
    Ok(splashdown(&words).output()?.status.success())
}

#[test]
fn every_command_is_accepted() -> Outcome {
    let mut count = 0;
    for (path, text) in pages()? {
        for command in commands(&text) {
            let is_missing = match command[0].as_str() {
                "view" => cfg!(not(feature = "window")),
                "plot" => cfg!(not(feature = "plot")),
                _ => false,
            };
            if is_missing {
                continue;
            }
            assert!(is_accepted(&command)?, "{}: splashdown {}", path.display(), command.join(" "));
            count += 1;
        }
    }
    assert!(count > 30, "only {count} commands were found");
    Ok(())
}

/// Control: wrong options and commands are detected.
#[test]
fn wrong_commands_are_refused() -> Outcome {
    let text =
        "```sh\nsplashdown run 'my scene.toml' --frame 3   # no such option\nsplashdown rnu | cat\n```\n";
    let found = commands(text);
    assert_eq!(found, [&["run", "my scene.toml", "--frame", "3"][..], &["rnu"]]);
    for command in found {
        assert!(!is_accepted(&command)?, "{command:?}");
    }
    Ok(())
}

#[test]
fn options_and_exit_codes_equal_those_of_the_help() -> Outcome {
    let text = page("command-line.md")?;
    let help = stdout(&splashdown(&["run", "--help"]).output()?);
    let table = text
        .split("## Options of `run`")
        .nth(1)
        .and_then(|rest| rest.split("\n## ").next())
        .ok_or("no table")?;
    let options: Vec<&str> = table.split(['`', ' ', ',']).filter(|word| word.starts_with("--")).collect();
    assert!(options.len() >= 10, "{options:?}");
    for option in options {
        assert!(help.contains(option), "the guide has {option}, but the help does not");
    }
    let codes = stdout(&splashdown(&["--help"]).output()?);
    let codes = codes.split("Exit codes:").nth(1).ok_or("no codes")?;
    for code in codes.split_whitespace().filter(|word| word.bytes().all(|byte| byte.is_ascii_digit())) {
        assert!(text.contains(&format!("| {code} |")), "the guide has no exit code {code}");
    }
    Ok(())
}

#[test]
fn formats_equal_those_of_the_help() -> Outcome {
    let text = page("other-programs.md")?;
    let help = stdout(&splashdown(&["run", "--help"]).output()?);
    let formats = help.split("--formats <LIST>").nth(1).and_then(|rest| rest.split("--no-surface").next());
    let mut count = 0;
    for line in formats.ok_or("no formats")?.lines() {
        let Some((format, _)) = line.trim().strip_prefix("- ").and_then(|line| line.split_once(':')) else {
            continue;
        };
        assert!(
            format == "none" || text.contains(&format!("| `{format}` |")),
            "the guide has no format {format}"
        );
        count += 1;
    }
    assert_eq!(count, 11, "ten formats and `none`");
    Ok(())
}

#[test]
fn the_first_scene_is_valid() -> Outcome {
    let text = page("first-simulation.md")?;
    let scene = text.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).ok_or("no scene")?;
    let place = Place::new()?;
    place.write("my.toml", scene)?;
    let output = place.splashdown(&["check", "my.toml", "--device", "cpu"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    Ok(())
}
