//! `splashdown completions`.

use clap::CommandFactory;

use crate::args::{Arguments, CompletionsArguments};
use crate::console;

/// Prints the completions of a shell.
pub fn run(arguments: &CompletionsArguments) {
    let mut text = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "splashdown", &mut text);
    console::print_raw(&text);
}
