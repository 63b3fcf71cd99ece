//! Kills a process with all its descendants.

use std::process::Command;

/// Kills all descendants of a process and, if `root` is set, the process itself. Failures are ignored: the caller has
/// already reported an error.
pub fn tree(process: u32, root: bool) {
    if cfg!(windows) {
        // taskkill can only end the whole tree.
        let _ = Command::new("taskkill").args(["/T", "/F", "/PID", &process.to_string()]).output();
        return;
    }
    // Parents first, so that no parent reacts to the end of its child.
    let mut processes = if root { vec![process] } else { Vec::new() };
    processes.extend(descendants(process, &parents()));
    let numbers: Vec<String> = processes.iter().map(u32::to_string).collect();
    let _ = Command::new("sh").arg("-c").arg(format!("kill -KILL {}", numbers.join(" "))).output();
}

/// Every process with its parent.
fn parents() -> Vec<(u32, u32)> {
    let Ok(output) = Command::new("ps").args(["-A", "-o", "pid=,ppid="]).output() else {
        return proc_parents();
    };
    let text = String::from_utf8_lossy(&output.stdout);
    text.lines().filter_map(|line| pair(line.split_whitespace())).collect()
}

/// The same from Linux's `/proc`, for systems without `ps`.
fn proc_parents() -> Vec<(u32, u32)> {
    let Ok(entries) = std::fs::read_dir("/proc") else { return Vec::new() };
    let stat = |entry: std::fs::DirEntry| std::fs::read_to_string(entry.path().join("stat")).ok();
    // `PID (NAME) STATE PPID ...`; a name may contain spaces and brackets.
    let parse = |text: String| {
        let (pid, rest) = text.split_once(' ')?;
        let (_, rest) = rest.rsplit_once(')')?;
        pair([pid, rest.split_whitespace().nth(1)?].into_iter())
    };
    entries.flatten().filter_map(stat).filter_map(parse).collect()
}

fn pair<'a>(mut words: impl Iterator<Item = &'a str>) -> Option<(u32, u32)> {
    Some((words.next()?.parse().ok()?, words.next()?.parse().ok()?))
}

fn descendants(process: u32, parents: &[(u32, u32)]) -> Vec<u32> {
    let mut found = vec![process];
    let mut next = 0;
    while next < found.len() {
        let parent = found[next];
        found.extend(parents.iter().filter(|(_, p)| *p == parent).map(|(pid, _)| *pid));
        next += 1;
    }
    found.split_off(1)
}

#[cfg(test)]
mod tests {
    use super::{descendants, parents, proc_parents};

    #[test]
    fn descendants_are_found_at_any_depth() {
        let parents = [(2, 1), (3, 2), (4, 3), (5, 1), (6, 5)];
        let mut found = descendants(2, &parents);
        found.sort_unstable();
        assert_eq!(found, [3, 4]);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn this_process_is_listed() {
        let own = std::process::id();
        assert!(parents().iter().chain(&proc_parents()).any(|&(pid, _)| pid == own));
        assert!(proc_parents().iter().any(|&(pid, _)| pid == own));
    }

    #[test]
    #[cfg(unix)]
    fn a_tree_is_killed() {
        let mut shell = std::process::Command::new("sh").args(["-c", "sleep 60 & wait"]).spawn().unwrap();
        let start = std::time::Instant::now();
        while descendants(shell.id(), &parents()).is_empty() {
            assert!(start.elapsed().as_secs() < 20);
        }
        super::tree(shell.id(), true);
        assert!(!shell.wait().unwrap().success());
        assert!(start.elapsed().as_secs() < 50);
    }
}
