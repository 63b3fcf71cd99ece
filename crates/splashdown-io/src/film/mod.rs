//! A film (H.264 in MP4), encoded by an `ffmpeg` child process that receives raw pictures through a pipe.
//!
//! **How it works.** One thread writes pictures to the pipe. Another reads the messages of `ffmpeg`, so that no full
//! pipe can block both processes. If the child ends early the pipe breaks, which is reported as an error. A child that
//! does not respond within a time limit is killed. The film has no name, or a hidden one, until it is complete.
//!
//! **Why not a library.** Bindings to libav need its headers on every build machine; there is no encoder in Rust of this
//! quality. Without `ffmpeg` the pictures are still written, and a message gives the command that makes the film.

use std::ffi::OsString;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crate::error::FilmError;

use crate::atomic::Temporary;
use crate::picture::Picture;

/// Bytes of the child's messages that are stored for an error.
const LOG_TAIL: usize = 2000;

/// Time between two checks of the child or the queue.
const PAUSE: Duration = Duration::from_millis(2);

/// Options of a film.
#[derive(Debug, Clone, PartialEq)]
pub struct FilmOptions {
    /// The film's file, ending in `.mp4`.
    pub path: PathBuf,
    /// Width of every picture in pixels. An odd width or height is padded by a black column or row.
    pub width: u32,
    /// Height of every picture in pixels.
    pub height: u32,
    /// Pictures per second.
    pub frame_rate: f64,
    /// The pictures' file names with `%04d` for their number, for the command in error messages.
    pub pictures: String,
    /// The program; `ffmpeg` is searched in PATH.
    pub program: PathBuf,
    /// Time limit for the program to accept a picture, or to end.
    pub stall_limit: Duration,
}

impl FilmOptions {
    /// Options for `ffmpeg` with a time limit of two minutes.
    #[must_use]
    pub fn new(
        path: impl Into<PathBuf>,
        width: u32,
        height: u32,
        frame_rate: f64,
        pictures: impl Into<String>,
    ) -> Self {
        Self {
            path: path.into(),
            width,
            height,
            frame_rate,
            pictures: pictures.into(),
            program: "ffmpeg".into(),
            stall_limit: Duration::from_secs(120),
        }
    }

    /// The command that makes the same film from the pictures.
    #[must_use]
    pub fn command_by_hand(&self) -> String {
        format!(
            "ffmpeg -framerate {} -i \"{}\" -vf \"{FILTER}\" -c:v libx264 -crf 18 -movflags +faststart \"{}\"",
            self.frame_rate,
            self.pictures,
            self.path.display()
        )
    }

    fn later(&self) -> String {
        format!("The pictures are complete; this command makes the film: {}", self.command_by_hand())
    }

    fn system(&self, path: &Path, error: &io::Error) -> FilmError {
        FilmError::System { path: path.to_owned(), detail: error.to_string(), later: self.later() }
    }

    fn command(&self, temporary: &Temporary) -> io::Result<Command> {
        let (output, stdout) = temporary.for_child()?;
        let mut command = Command::new(&self.program);
        command.args(["-hide_banner", "-loglevel", "error", "-y"]);
        command.args(["-f", "rawvideo", "-pixel_format", "rgba"]);
        command.args(["-video_size", &format!("{}x{}", self.width, self.height)]);
        command.args(["-framerate", &self.frame_rate.to_string(), "-i", "pipe:0"]);
        // The fast preset leaves most of the processor to the simulation (50 pictures of 720p: 0.8 s on two cores). At
        // quality 18, losses are hard to see.
        command.args(["-vf", FILTER, "-c:v", "libx264", "-preset", "veryfast", "-crf", "18"]);
        command.args(["-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"]);
        command.args(["-movflags", "+faststart", "-f", "mp4"]);
        // The prefix prevents that a name with a colon or a leading dash is parsed as a protocol or an option.
        let mut file = OsString::from("file:");
        file.push(output);
        command.arg(file);
        command.stdin(Stdio::piped()).stdout(stdout).stderr(Stdio::piped());
        Ok(command)
    }
}

/// H.264 in 4:2:0 needs even sizes; players assume BT.709 for HD.
const FILTER: &str = "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p";

/// A film that is being made. It is shared by `Arc`: the writer's thread adds pictures ([`crate::Job::Film`]), and its
/// owner finishes it. If it is dropped unfinished, no file and no child process remain.
#[derive(Debug)]
pub struct Film {
    options: FilmOptions,
    state: Mutex<State>,
}

#[derive(Debug)]
enum State {
    Running(Encoder),
    Ended(Result<u64, FilmError>),
}

impl Film {
    /// Whether this program exists and can encode H.264.
    #[must_use]
    pub fn can_encode(program: &Path) -> bool {
        encoders(program).is_ok_and(|list| has_h264(&list))
    }

    /// Starts the program, after checking that it exists and can encode H.264.
    ///
    /// # Errors
    /// [`FilmError::NotInstalled`], [`FilmError::NoH264`], [`FilmError::Options`] or [`FilmError::System`].
    pub fn start(options: FilmOptions) -> Result<Self, FilmError> {
        let FilmOptions { width, height, frame_rate, .. } = options;
        if width == 0 || height == 0 || !(frame_rate.is_finite() && frame_rate > 0.0) {
            return Err(FilmError::Options { width, height, frame_rate });
        }
        let program = options.program.clone();
        let encoders = encoders(&program).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => {
                FilmError::NotInstalled { program: program.clone(), later: options.later() }
            }
            _ => options.system(&program, &error),
        })?;
        if !has_h264(&encoders) {
            return Err(FilmError::NoH264 { program, later: options.later() });
        }
        let encoder = Encoder::start(&options).map_err(|error| options.system(&program, &error))?;
        Ok(Self { state: Mutex::new(State::Running(encoder)), options })
    }

    /// Adds a picture; blocks while the encoder is busy. A failure ends the film and is reported by [`Film::finish`];
    /// later pictures are ignored.
    pub fn push(&self, picture: &Arc<Picture>) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let State::Running(encoder) = &mut *state else { return };
        if let Err(error) = encoder.push(picture, &self.options) {
            *state = State::Ended(Err(error));
        }
    }

    /// Completes the film and renames it; returns its size in bytes. A second call returns the same.
    ///
    /// # Errors
    /// The first failure since the start.
    pub fn finish(&self) -> Result<u64, FilmError> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if let State::Running(encoder) = &mut *state {
            let result = encoder.finish(&self.options);
            *state = State::Ended(result);
        }
        match &*state {
            State::Ended(result) => result.clone(),
            State::Running(_) => Err(FilmError::Empty),
        }
    }

    /// The options of the film.
    #[must_use]
    pub fn options(&self) -> &FilmOptions {
        &self.options
    }
}

/// The program's list of encoders.
fn encoders(program: &Path) -> io::Result<Vec<u8>> {
    let output = Command::new(program).args(["-hide_banner", "-encoders"]).stdin(Stdio::null()).output();
    output.map(|output| output.stdout)
}

fn has_h264(encoders: &[u8]) -> bool {
    String::from_utf8_lossy(encoders).split_whitespace().any(|word| word == "libx264")
}

/// The child and the two threads of its pipes. The threads are not joined: they end when the pipes are closed, which
/// remain open if a killed child (a wrapper script) has a child process of its own.
#[derive(Debug)]
struct Encoder {
    child: Child,
    /// The film until it is complete.
    temporary: Option<Temporary>,
    pictures: Option<SyncSender<Arc<Picture>>>,
    pushed: u64,
    delivered: Arc<AtomicU64>,
    log: Arc<Mutex<Vec<u8>>>,
    listener: JoinHandle<()>,
}

impl Encoder {
    fn start(options: &FilmOptions) -> io::Result<Self> {
        let temporary = Temporary::create(&options.path)?;
        let mut child = options.command(&temporary)?.spawn()?;
        let temporary = Some(temporary);
        let (pictures, queue) = sync_channel(1);
        let (delivered, log) = (Arc::new(AtomicU64::new(0)), Arc::new(Mutex::new(Vec::new())));
        let threads = || {
            let (stdin, stderr) = (child.stdin.take(), child.stderr.take());
            let (count, tail) = (Arc::clone(&delivered), Arc::clone(&log));
            let named = |name: &str| thread::Builder::new().name(name.to_owned());
            named("splashdown-film-feed").spawn(move || feed(stdin, &queue, &count))?;
            named("splashdown-film-log").spawn(move || listen(stderr, &tail))
        };
        match threads() {
            Ok(listener) => {
                Ok(Self { child, temporary, pictures: Some(pictures), pushed: 0, delivered, log, listener })
            }
            Err(error) => {
                stop(&mut child);
                Err(error)
            }
        }
    }

    fn push(&mut self, picture: &Arc<Picture>, options: &FilmOptions) -> Result<(), FilmError> {
        let (given, expected) = ((picture.width, picture.height), (options.width, options.height));
        if given != expected || picture.check().is_err() {
            let (number, bytes) = (self.pushed, picture.rgba.len());
            return Err(FilmError::PictureSize { number, given, bytes, expected, later: options.later() });
        }
        let Some(queue) = self.pictures.clone() else { return Ok(()) };
        let deadline = Instant::now() + options.stall_limit;
        let mut waiting = Arc::clone(picture);
        loop {
            match queue.try_send(waiting) {
                Ok(()) => break,
                Err(TrySendError::Full(_)) if Instant::now() > deadline => return Err(self.stalled(options)),
                Err(TrySendError::Full(back)) => {
                    waiting = back;
                    thread::sleep(PAUSE);
                }
                Err(TrySendError::Disconnected(_)) => return Err(self.died(options)),
            }
        }
        self.pushed += 1;
        Ok(())
    }

    fn finish(&mut self, options: &FilmOptions) -> Result<u64, FilmError> {
        if self.pushed == 0 {
            return Err(FilmError::Empty);
        }
        // Closing the queue closes the pipe, which is the end of the input for the child.
        drop(self.pictures.take());
        let Some(status) = self.wait(options.stall_limit) else { return Err(self.stalled(options)) };
        if !status.success() || self.delivered.load(Ordering::Acquire) != self.pushed {
            return Err(self.died(options));
        }
        let Some(temporary) = self.temporary.take() else { return Err(FilmError::Empty) };
        let named = temporary.persist(&options.path).and_then(|()| options.path.metadata());
        named.map(|data| data.len()).map_err(|error| options.system(&options.path, &error))
    }

    /// The child's exit status, if it ends within the time limit.
    fn wait(&mut self, limit: Duration) -> Option<ExitStatus> {
        let deadline = Instant::now() + limit;
        loop {
            match self.child.try_wait() {
                Ok(Some(status)) => return Some(status),
                Ok(None) if Instant::now() < deadline => thread::sleep(PAUSE),
                Ok(None) | Err(_) => return None,
            }
        }
    }

    fn died(&mut self, options: &FilmOptions) -> FilmError {
        let status =
            self.wait(Duration::from_secs(5)).map_or_else(|| "no status".to_owned(), |s| s.to_string());
        FilmError::Died {
            program: options.program.clone(),
            status,
            log: self.last_messages(),
            later: options.later(),
        }
    }

    fn stalled(&mut self, options: &FilmOptions) -> FilmError {
        stop(&mut self.child);
        FilmError::Stalled {
            program: options.program.clone(),
            seconds: options.stall_limit.as_secs_f64(),
            log: self.last_messages(),
            later: options.later(),
        }
    }

    /// The end of the child's messages, on one line. The child has ended; the listener gets a second to read the rest.
    fn last_messages(&self) -> String {
        let deadline = Instant::now() + Duration::from_secs(1);
        while !self.listener.is_finished() && Instant::now() < deadline {
            thread::sleep(PAUSE);
        }
        let log = self.log.lock().unwrap_or_else(PoisonError::into_inner);
        let words = String::from_utf8_lossy(&log).split_whitespace().collect::<Vec<_>>().join(" ");
        if words.is_empty() { "it printed no message".to_owned() } else { words }
    }
}

impl Drop for Encoder {
    fn drop(&mut self) {
        stop(&mut self.child);
    }
}

/// Kills and reaps the child; harmless if it has ended.
fn stop(child: &mut Child) {
    // Both fail only if the child has already ended.
    let _ = child.kill();
    let _ = child.wait();
}

/// The feeding thread, which ends with the queue or the pipe.
fn feed(stdin: Option<ChildStdin>, queue: &Receiver<Arc<Picture>>, delivered: &AtomicU64) {
    let Some(mut stdin) = stdin else { return };
    for picture in queue {
        if stdin.write_all(&picture.rgba).is_err() {
            return;
        }
        delivered.fetch_add(1, Ordering::Release);
    }
}

/// The listening thread, which stores the end of the child's messages.
fn listen(stderr: Option<ChildStderr>, log: &Mutex<Vec<u8>>) {
    let Some(mut stderr) = stderr else { return };
    let mut buffer = [0; 1024];
    while let Ok(length @ 1..) = stderr.read(&mut buffer) {
        let mut log = log.lock().unwrap_or_else(PoisonError::into_inner);
        log.extend_from_slice(&buffer[..length]);
        let surplus = log.len().saturating_sub(LOG_TAIL);
        log.drain(..surplus);
    }
}
