//! Checks the order of a crate's modules: no cycle, and no upward import.

use std::collections::{BTreeMap, BTreeSet};

use super::graph::{Graph, ROOT};

/// The declared order of a crate's modules: the first code block after the heading `# Modules` in the documentation of
/// the crate root, from top to bottom. Modules on one line do not import each other. `None` without such a block.
pub fn declared(root: &str) -> Option<Vec<Vec<String>>> {
    let lines = root.lines().filter_map(|line| line.strip_prefix("//!")).map(str::trim);
    let mut lines = lines.skip_while(|line| *line != "# Modules").skip_while(|line| !line.starts_with("```"));
    lines.next()?;
    let lines = lines.take_while(|line| !line.starts_with("```"));
    Some(lines.map(|line| line.split_whitespace().map(str::to_owned).collect()).collect())
}

/// The problems of a graph: a cycle, or imports that violate the declared order.
pub fn problems(graph: &Graph, order: Option<&[Vec<String>]>) -> Vec<String> {
    let mut problems = Vec::new();
    for (from, edges) in graph {
        if let Some(file) = edges.get(ROOT) {
            let file = file.display();
            problems.push(format!("`{from}` imports an item of {ROOT} ({file}): move it to a module below"));
        }
    }
    if let Some(cycle) = cycle(graph) {
        let arrow = |pair: &[String]| {
            let file = graph[&pair[0]][&pair[1]].display();
            format!("`{}` imports `{}` ({file})", pair[0], pair[1])
        };
        let arrows: Vec<String> = cycle.windows(2).map(arrow).collect();
        problems.push(format!("a cycle: {}", arrows.join(", ")));
    }
    let Some(order) = order else { return problems };
    let mut heights = BTreeMap::new();
    for (height, name) in
        order.iter().rev().enumerate().flat_map(|(h, names)| names.iter().map(move |n| (h, n)))
    {
        if heights.insert(name.as_str(), height).is_some() {
            problems.push(format!("the declared order names `{name}` twice"));
        }
        if !graph.contains_key(name) {
            problems.push(format!("the declared order names `{name}`, which is not a module"));
        }
    }
    for (from, edges) in graph {
        let Some(height) = heights.get(from.as_str()) else {
            problems.push(format!("the declared order lacks `{from}`"));
            continue;
        };
        for (to, file) in edges {
            if heights.get(to.as_str()).is_some_and(|other| other >= height) {
                let file = file.display();
                problems.push(format!("`{from}` imports `{to}`, which is not below it ({file})"));
            }
        }
    }
    problems
}

/// The modules along a cycle; the first one is repeated at the end.
fn cycle(graph: &Graph) -> Option<Vec<String>> {
    let mut done = BTreeSet::new();
    graph.keys().find_map(|start| visit(graph, start, &mut Vec::new(), &mut done))
}

fn visit<'a>(
    graph: &'a Graph,
    name: &'a str,
    path: &mut Vec<&'a str>,
    done: &mut BTreeSet<&'a str>,
) -> Option<Vec<String>> {
    if let Some(start) = path.iter().position(|&other| other == name) {
        return Some(path[start..].iter().chain([&name]).map(|&name| name.to_owned()).collect());
    }
    if done.contains(name) {
        return None;
    }
    path.push(name);
    let edges = graph.get(name).into_iter().flat_map(|edges| edges.keys());
    let found = edges.into_iter().find_map(|to| visit(graph, to, path, done));
    path.pop();
    done.insert(name);
    found
}

/// The modules from top to bottom: in the declared order, or else each module above those that it imports.
pub fn sorted(graph: &Graph, order: Option<&[Vec<String>]>) -> Vec<String> {
    if let Some(order) = order {
        return order.concat();
    }
    let mut sorted: Vec<String> = Vec::new();
    while let Some(lowest) = graph.iter().find(|(name, edges)| {
        !sorted.contains(name) && edges.keys().all(|to| sorted.contains(to) || !graph.contains_key(to))
    }) {
        sorted.push(lowest.0.clone());
    }
    // Modules on a cycle, and those that import them.
    sorted.extend(graph.keys().filter(|name| !sorted.contains(name)).cloned().collect::<Vec<_>>());
    sorted.reverse();
    sorted
}

#[cfg(test)]
mod tests {
    use super::{declared, problems, sorted};
    use crate::modules::graph::{Graph, graph};

    fn of(files: &[(&str, &str)]) -> Graph {
        let sources: Vec<_> = files.iter().map(|(path, text)| (path.into(), (*text).to_owned())).collect();
        graph(&sources)
    }

    const LIB: (&str, &str) =
        ("lib.rs", "//! A crate.\n//!\n//! # Modules\n//!\n//! ```text\n//! c\n//! b a\n//! ```\n");

    #[test]
    fn an_acyclic_crate_passes() {
        let graph = of(&[LIB, ("a.rs", ""), ("b.rs", ""), ("c.rs", "use crate::a; use crate::b;")]);
        let order = declared(LIB.1);
        assert_eq!(order, Some(vec![vec!["c".to_owned()], vec!["b".into(), "a".into()]]));
        assert_eq!(problems(&graph, order.as_deref()), [""; 0]);
        assert_eq!(sorted(&graph, None), ["c", "b", "a"]);
    }

    #[test]
    fn a_cycle_fails() {
        let files = [LIB, ("a.rs", "use crate::c::x;"), ("b.rs", ""), ("c.rs", "fn f() { super::a::g() }")];
        let problems = problems(&of(&files), None);
        assert_eq!(problems.len(), 1, "{problems:?}");
        assert!(problems[0].contains("`a` imports `c` (a.rs), `c` imports `a` (c.rs)"), "{problems:?}");
        // Without one of the two imports there is no cycle.
        let files = [LIB, ("a.rs", "// use crate::c::x;"), files[2], files[3]];
        assert_eq!(super::problems(&of(&files), None), [""; 0]);
    }

    #[test]
    fn an_upward_or_sideways_import_fails() {
        for (from, to) in [("a.rs", "use crate::c;"), ("b.rs", "use crate::a;"), ("a.rs", "use crate::item;")]
        {
            let mut files = vec![LIB, ("a.rs", ""), ("b.rs", ""), ("c.rs", "")];
            files.push((from, to));
            files.retain(|file| file.0 != from || file.1 == to);
            let found = problems(&of(&files), declared(LIB.1).as_deref());
            assert_eq!(found.len(), 1, "{to}: {found:?}");
        }
    }

    #[test]
    fn a_declared_order_that_does_not_match_the_crate_fails() {
        let found =
            problems(&of(&[LIB, ("a.rs", ""), ("c.rs", ""), ("d.rs", "")]), declared(LIB.1).as_deref());
        assert_eq!(
            found,
            ["the declared order names `b`, which is not a module", "the declared order lacks `d`"]
        );
    }
}
