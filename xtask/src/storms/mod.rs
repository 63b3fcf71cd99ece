//! `cargo xtask storms`: runs random scenes with the real program and judges the particles of each run by an independent
//! check. A *silent failure* is a run that succeeds without a warning although its particles are implausible.

mod judge;
mod ply;
mod report;
mod rng;
mod scene;
mod shipped;

use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};

use self::judge::Measures;
use self::scene::{Only, Storm};
use crate::layers::Outcome;
use crate::process::{self, say};

/// The seed of the published report.
const SEED: u64 = 1;
/// Scenes in the tests.
const FEW: u64 = 20;
/// A run that takes longer is a failure.
const LIMIT: Duration = Duration::from_secs(600);
/// The report of a full search.
const PAGE: &str = "docs/storms.md";

/// The arguments.
#[derive(Clone, Debug)]
struct Settings {
    scenes: u64,
    first: u64,
    seed: u64,
    workers: usize,
    only: Only,
    /// Instead of random scenes, those that come with the program, with their spacing multiplied by this.
    shipped: Option<f64>,
    binary: Option<PathBuf>,
    /// Run with `--on-burst ignore`, to judge runs to their end.
    ignore: bool,
}

/// How a run ended, by its exit code and its messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum End {
    /// Success, without a warning of the monitor.
    Silent,
    /// Success, with warnings.
    Warned(String),
    /// Stopped with a message.
    Stopped(String),
    /// The scene was refused before the first step.
    Refused(String),
    /// A panic, a signal, or no end.
    Crashed(String),
}

/// The result of a scene.
#[derive(Clone, Debug)]
pub struct Judged {
    pub storm: Storm,
    pub end: End,
    /// Why the particles are implausible; empty if they are not.
    pub reasons: Vec<String>,
    pub start: Measures,
    /// The largest measures of all frames.
    pub worst: Measures,
    /// The largest gain of energy.
    pub gain: f64,
    pub seconds: f64,
}

impl Judged {
    /// True if the run is implausible and did not say so.
    pub fn is_silent_failure(&self) -> bool {
        self.end == End::Silent && !self.reasons.is_empty()
    }
}

/// The command `storms`.
pub fn run(arguments: &[String]) -> Result<()> {
    let settings = settings(arguments)?;
    let binary = match &settings.binary {
        Some(binary) => binary.clone(),
        None => process::build_release()?,
    };
    if let Some(coarser) = settings.shipped {
        return shipped::run(&settings, &binary, coarser);
    }
    let (judged, seconds) = search(&settings, &binary)?;
    let page = report::page(&judged, &report::command(arguments), seconds);
    say(&page);
    let is_full = settings.scenes >= 1000 && settings.seed == SEED && !settings.only.continuity;
    if is_full {
        std::fs::write(process::root().join(PAGE), &page)?;
    }
    let silent = judged.iter().filter(|one| one.is_silent_failure()).count();
    let crashed = judged.iter().filter(|one| matches!(one.end, End::Crashed(_))).count();
    ensure!(
        silent + crashed == 0,
        "{silent} silent failures and {crashed} crashes of {} scenes",
        judged.len()
    );
    Ok(())
}

/// A few scenes, as a layer of the tests, with the binary that they have built.
pub fn layer() -> Result<Outcome> {
    let binary = process::build_tested()?;
    let settings = Settings { scenes: FEW, ..settings(&[])? };
    let (judged, _) = search(&settings, &binary)?;
    let is_bad = |one: &Judged| one.is_silent_failure() || matches!(one.end, End::Crashed(_));
    let bad: Vec<&str> = judged.iter().filter(|one| is_bad(one)).map(|one| one.storm.name.as_str()).collect();
    ensure!(bad.is_empty(), "silent failures or crashes: {}", bad.join(", "));
    Ok(Outcome::Passed)
}

fn settings(arguments: &[String]) -> Result<Settings> {
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    let mut settings = Settings {
        scenes: 1000,
        first: 0,
        seed: SEED,
        workers,
        only: Only::default(),
        shipped: None,
        binary: None,
        ignore: false,
    };
    let mut words = arguments.iter();
    while let Some(word) = words.next() {
        let mut value = || words.next().with_context(|| format!("{word} needs a value"));
        let mut count = || {
            let text = value()?;
            text.parse::<u64>().with_context(|| format!("{word} needs a whole number, not {text}"))
        };
        match word.as_str() {
            "--scenes" => settings.scenes = count()?,
            "--first" => settings.first = count()?,
            "--seed" => settings.seed = count()?,
            "--workers" => settings.workers = usize::try_from(count()?)?,
            "--binary" => settings.binary = Some(value()?.into()),
            "--shipped" => {
                let text = value()?;
                let factor = text.parse().with_context(|| format!("--shipped needs a number, not {text}"))?;
                settings.shipped = Some(factor);
            }
            "--continuity" => settings.only.continuity = true,
            "--ignore" => settings.ignore = true,
            other => bail!("storms does not know {other}; see `cargo xtask help`"),
        }
    }
    Ok(settings)
}

/// Runs the scenes, several at a time, and returns them in order with the wall time in s.
fn search(settings: &Settings, binary: &Path) -> Result<(Vec<Judged>, f64)> {
    let begun = Instant::now();
    let folder = process::target().join("storms");
    std::fs::create_dir_all(&folder)?;
    let (next, done) = (AtomicU64::new(0), Mutex::new(Vec::new()));
    let failure: Mutex<Option<anyhow::Error>> = Mutex::new(None);
    std::thread::scope(|scope| {
        for _ in 0..settings.workers.max(1) {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= settings.scenes {
                        break;
                    }
                    let storm = scene::storm(settings.seed, settings.first + number, settings.only);
                    match judge_run(settings, binary, &folder, storm) {
                        Ok(judged) => {
                            tell(&judged);
                            done.lock().unwrap_or_else(|e| e.into_inner()).push(judged);
                        }
                        Err(error) => *failure.lock().unwrap_or_else(|e| e.into_inner()) = Some(error),
                    }
                }
            });
        }
    });
    if let Some(error) = failure.into_inner().unwrap_or_else(|e| e.into_inner()) {
        return Err(error);
    }
    let mut done = done.into_inner().unwrap_or_else(|e| e.into_inner());
    done.sort_by(|a, b| a.storm.name.cmp(&b.storm.name));
    Ok((done, begun.elapsed().as_secs_f64()))
}

/// A line for each scene that is not plain.
fn tell(judged: &Judged) {
    let kind = match (&judged.end, judged.reasons.is_empty()) {
        (End::Silent, true) => return,
        (End::Silent, false) => "SILENT FAILURE",
        (End::Warned(_), true) => "warned, plausible",
        (End::Warned(_), false) => "warned, implausible",
        (End::Stopped(_), true) => "stopped, plausible",
        (End::Stopped(_), false) => "stopped, implausible",
        (End::Refused(_), _) => "refused",
        (End::Crashed(_), _) => "CRASHED",
    };
    let message = match &judged.end {
        End::Silent => "",
        End::Warned(text) | End::Stopped(text) | End::Refused(text) | End::Crashed(text) => text,
    };
    let traits = judged.storm.traits.join(", ");
    let Measures { fastest, fast, densest, dense, .. } = judged.worst;
    say(format!(
        "{}: {kind} [{traits}] speed {fastest:.2} {fast:.2} density {densest:.2} {dense:.2} gain {:.2} | {} | {}",
        judged.storm.name,
        judged.gain,
        judged.reasons.join("; "),
        message.chars().take(300).collect::<String>()
    ));
}

fn judge_run(settings: &Settings, binary: &Path, folder: &Path, storm: Storm) -> Result<Judged> {
    let begun = Instant::now();
    let file = folder.join(format!("{}.toml", storm.name));
    std::fs::write(&file, &storm.text)?;
    let out = folder.join(&storm.name);
    let end = execute(settings, binary, &file, &out)?;
    let mut frames: Vec<PathBuf> = std::fs::read_dir(out.join("particles"))
        .into_iter()
        .flatten()
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|ending| ending == "ply"))
        .collect();
    frames.sort();
    let mut judged = Judged {
        storm,
        end,
        reasons: Vec::new(),
        start: Measures::default(),
        worst: Measures::default(),
        gain: f64::NEG_INFINITY,
        seconds: 0.0,
    };
    for (number, path) in frames.iter().enumerate() {
        let now = judge::measure(&judged.storm.facts, &ply::read(path)?);
        if number == 0 {
            judged.start = now;
        }
        let reasons = judge::verdict(&judged.storm.facts, &judged.start, &now);
        if judged.reasons.is_empty() && !reasons.is_empty() {
            judged.reasons = reasons.into_iter().map(|reason| format!("frame {number}: {reason}")).collect();
        }
        if let Some(gain) = judge::gain(&judged.storm.facts, &judged.start, &now) {
            judged.gain = judged.gain.max(gain);
        }
        let worst = &mut judged.worst;
        worst.fastest = worst.fastest.max(now.fastest);
        worst.fast = worst.fast.max(now.fast);
        worst.densest = worst.densest.max(now.densest);
        worst.dense = worst.dense.max(now.dense);
    }
    // The scene and the messages of a plain run are not needed any more.
    std::fs::remove_dir_all(&out).ok();
    judged.seconds = begun.elapsed().as_secs_f64();
    Ok(judged)
}

/// Runs a scene and reads its messages.
fn execute(settings: &Settings, binary: &Path, file: &Path, out: &Path) -> Result<End> {
    let mut command = process::command(binary);
    command.arg("run").arg(file).arg("--out").arg(out);
    command.args([
        "--device",
        "cpu",
        "--json",
        "--no-pictures",
        "--no-surface",
        "--no-sync",
        "--formats",
        "ply",
    ]);
    if settings.ignore {
        command.args(["--on-burst", "ignore"]);
    }
    // One thread per run: several runs use the processors better than one run of a few particles.
    command.env("RAYON_NUM_THREADS", "1").stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = command.spawn()?;
    let id = child.id();
    let ended = Arc::new(Mutex::new(false));
    let watched = Arc::clone(&ended);
    let watch = std::thread::Builder::new().name("time limit".to_owned()).spawn(move || {
        let begun = Instant::now();
        while begun.elapsed() < LIMIT {
            std::thread::sleep(Duration::from_millis(50));
            if *watched.lock().unwrap_or_else(|e| e.into_inner()) {
                return false;
            }
        }
        crate::kill::tree(id, true);
        true
    })?;
    let output = child.wait_with_output()?;
    *ended.lock().unwrap_or_else(|e| e.into_inner()) = true;
    let was_killed = watch.join().unwrap_or_default();
    let lines: Vec<serde_json::Value> = String::from_utf8_lossy(&output.stdout)
        .lines()
        .filter_map(|line| serde_json::from_str(line).ok())
        .collect();
    let messages = |event: &str| -> Vec<String> {
        let found = lines.iter().filter(|line| line["event"] == event);
        found.filter_map(|line| Some(line["message"].as_str()?.to_owned())).collect()
    };
    // Warnings before the first step, and of water that leaves through open sides, do not report a burst.
    let warnings: Vec<String> = messages("warning")
        .into_iter()
        .filter(|text| {
            text.starts_with("at ") && !text.contains("open sides") && !text.contains("has left the domain")
        })
        .collect();
    let errors = messages("error").join("; ");
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    Ok(match output.status.code() {
        _ if was_killed => End::Crashed(format!("no end after {} s", LIMIT.as_secs())),
        Some(0) if warnings.is_empty() => End::Silent,
        Some(0) => End::Warned(warnings.join(" / ")),
        Some(1) if !errors.is_empty() => End::Stopped(errors),
        Some(3) => End::Refused(errors),
        _ => End::Crashed(format!("{}: {}", output.status, stderr.chars().take(400).collect::<String>())),
    })
}
