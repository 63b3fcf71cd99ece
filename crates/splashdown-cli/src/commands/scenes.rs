//! `splashdown scenes`.

use std::path::{Path, PathBuf};

use splashdown::check::reference;
use splashdown::scene::{Derived, Scene, presets, schema};
use splashdown_io::atomic;

use crate::args::{ScenesAction, ScenesArguments};
use crate::console;
use crate::exit::{Exit, Failure};
use crate::human;
use crate::scene_file;

/// Lists, shows or copies built-in scenes.
pub fn run(arguments: &ScenesArguments) -> Result<(), Failure> {
    match &arguments.action {
        None | Some(ScenesAction::List) => list(),
        Some(ScenesAction::Show { name }) => {
            console::print_raw(find(name)?.as_bytes());
            Ok(())
        }
        Some(ScenesAction::Copy { name, destination, force }) => copy(name, destination, *force),
        Some(ScenesAction::Schema) => {
            console::print_json_pretty(&schema());
            Ok(())
        }
        Some(ScenesAction::Reference) => {
            console::print_raw(reference().as_bytes());
            Ok(())
        }
    }
}

fn find(name: &str) -> Result<&'static str, Failure> {
    scene_file::preset(name).map(|(_, text)| text).ok_or_else(|| {
        let names = presets().iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
        Failure::new(
            Exit::Usage,
            format!("there is no built-in scene `{name}`; the built-in scenes are {names}"),
        )
    })
}

fn list() -> Result<(), Failure> {
    let width = presets().iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    for (name, text) in presets() {
        let scene = Scene::parse(text, name)?;
        let derived = Derived::new(&scene);
        let particles = human::count(derived.particles + derived.emitted);
        let bound = if derived.emitted > 0 { "up to" } else { "" };
        console::print(format!("{name:width$}  {bound:>5} {particles:>7} particles  {}", about(text)));
    }
    console::print("\nRun one with `splashdown run NAME`, print it with `splashdown scenes show NAME`.");
    Ok(())
}

/// The first sentence of the comment at the start of a scene file.
fn about(text: &str) -> String {
    let comment: Vec<&str> = text.lines().map_while(|line| line.strip_prefix('#')).map(str::trim).collect();
    let comment = comment.join(" ");
    match comment.find(". ") {
        Some(end) => comment[..=end].to_owned(),
        None => comment,
    }
}

fn copy(name: &str, destination: &Path, force: bool) -> Result<(), Failure> {
    let text = find(name)?;
    let path: PathBuf =
        if destination.is_dir() { destination.join(format!("{name}.toml")) } else { destination.to_owned() };
    if path.exists() && !force {
        let message = format!("`{}` exists; --force overwrites it", path.display());
        return Err(Failure::new(Exit::Files, message));
    }
    atomic::write(&path, |out| out.write_all(text.as_bytes()))?;
    console::print(path.display());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::about;

    #[test]
    fn the_first_sentence_of_the_comment_describes_a_scene() {
        assert_eq!(
            about("# A drop, 3.2 cm\n# across, falls. It splashes.\n[scene]\n# no"),
            "A drop, 3.2 cm across, falls."
        );
        assert_eq!(about("# Short\n"), "Short");
        assert_eq!(about("[scene]"), "");
    }
}
