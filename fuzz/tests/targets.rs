//! Repeats the earlier findings, and searches for new ones: with `CI=true` ten seconds per target, else one.

use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::time::Duration;

use fuzz::memory::Counting;
use fuzz::{Target, replay, search, targets};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn earlier_findings_are_handled() {
    splashdown_io::set_input_limit(Some(fuzz::INPUT_LIMIT));
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    let mut repeated = 0;
    for target in targets() {
        for entry in fs::read_dir(corpus.join(target.name)).into_iter().flatten().flatten() {
            let input = fs::read(entry.path()).unwrap();
            let finding = replay(&target, input).unwrap().finding;
            assert!(finding.is_none(), "{}: {:?}", entry.path().display(), finding.map(|it| it.reason));
            repeated += 1;
        }
    }
    assert!(repeated > 0, "the corpus is empty");
}

#[test]
fn random_inputs_are_read_or_refused() {
    splashdown_io::set_input_limit(Some(fuzz::INPUT_LIMIT));
    let seconds = if std::env::var("CI").as_deref() == Ok("true") { 10.0 } else { 1.0 };
    // Two threads, because other tests need the machine, too.
    let waiting = Mutex::new(targets());
    let findings = Mutex::new(Vec::new());
    let work = || {
        loop {
            let next = waiting.lock().unwrap().pop();
            let Some(target) = next else { break };
            let outcome = search(&target, Duration::from_secs_f64(seconds), 1).unwrap();
            eprintln!("{}: {} inputs, {} valid", target.name, outcome.inputs, outcome.accepted);
            assert!(outcome.accepted > 0, "{}: no seed is valid", target.name);
            if let Some(finding) = outcome.finding {
                let text = String::from_utf8_lossy(&finding.input).escape_debug().to_string();
                findings.lock().unwrap().push(format!("{}: {}: {text:.2000}", target.name, finding.reason));
            }
        }
    };
    std::thread::scope(|scope| {
        let second = scope.spawn(work);
        work();
        second.join().unwrap();
    });
    let findings = findings.into_inner().unwrap();
    assert!(findings.is_empty(), "`cargo xtask fuzz` writes the inputs:\n{}", findings.join("\n"));
}

/// Control: the search finds a panic, too much memory and a slow input.
#[test]
fn a_faulty_reader_is_found() {
    let seeds = || Ok(vec![b"12 34".to_vec()]);
    let of = |run| Target { name: "faulty", seeds, run, memory: 1 << 20 };
    let fails = of(|bytes, _| {
        assert!(!bytes.starts_with(b"0"), "a zero");
        true
    });
    let found =
        |target: &Target| search(target, Duration::from_secs(20), 1).unwrap().finding.map(|it| it.reason);
    assert_eq!(found(&fails).as_deref(), Some("panic: a zero"));
    let hungry = of(|bytes, _| bytes.starts_with(b"0") && vec![1_u8; 2 << 20].len() > bytes.len());
    assert!(found(&hungry).is_some_and(|reason| reason.starts_with("2 MiB")));
}
