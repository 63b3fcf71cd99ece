//! Problems of a scene as plain sentences. The messages of the command line contain lines of the file, for which a
//! notification has no place.

use splashdown::scene::{SceneErrors, SceneProblem};

/// The first problem of a scene that was changed in the window, and the number of the others.
pub fn of_scene(errors: &SceneErrors) -> String {
    errors.errors.first().map_or_else(|| errors.to_string(), |first| sentence(first) + &others(errors))
}

/// As [`of_scene`], with the file and the line.
pub fn of_file(errors: &SceneErrors) -> String {
    let line = errors.errors.first().and_then(|problem| problem.line);
    let line = line.map_or_else(String::new, |line| format!(", line {line}"));
    format!("{}{line}: {}", errors.file, of_scene(errors))
}

fn sentence(problem: &SceneProblem) -> String {
    let allowed =
        problem.allowed.as_ref().map_or_else(String::new, |allowed| format!(" (allowed: {allowed})"));
    let hint = problem.hint.as_ref().map_or_else(String::new, |hint| format!("; {hint}"));
    // Messages of the parser of TOML have several lines.
    let words: Vec<String> =
        [&problem.message, &allowed, &hint].map(|part| part.replace(['\n', '\r'], " ")).into();
    words.concat()
}

fn others(errors: &SceneErrors) -> String {
    match errors.errors.len() {
        0 | 1 => String::new(),
        2 => ". There is another problem".to_owned(),
        count => format!(". There are {} other problems", count - 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use splashdown::scene::{Scene, presets};

    fn errors(text: &str) -> SceneErrors {
        Scene::parse(text, "a.toml").unwrap_err()
    }

    #[test]
    fn a_problem_is_one_line_without_marks() {
        let (_, text) = presets()[0];
        let damaged = text.replace("particle_spacing = ", "particle_spacing = -");
        for (text, expected) in [(damaged.as_str(), "particle_spacing"), ("[scene", "")] {
            let errors = errors(text);
            // Control: the message of the command line has several lines and a mark.
            assert!(errors.to_string().contains("^") && errors.to_string().lines().count() > 3, "{errors}");
            for sentence in [of_scene(&errors), of_file(&errors)] {
                assert!(!sentence.contains(['^', '\n']), "{sentence}");
                assert!(sentence.contains(expected) && sentence.len() > 20, "{sentence}");
            }
            assert!(of_file(&errors).starts_with("a.toml, line "), "{}", of_file(&errors));
        }
    }

    #[test]
    fn other_problems_are_counted() {
        let (_, text) = presets()[0];
        let two = text
            .replace("duration = ", "duration = -")
            .replace("particle_spacing = ", "particle_spacing = -");
        let errors = errors(&two);
        assert!(errors.errors.len() > 1, "{errors}");
        assert!(of_scene(&errors).contains("other problem") || of_scene(&errors).contains("another problem"));
    }
}
