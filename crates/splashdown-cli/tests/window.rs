//! Starts the window on a virtual X server and checks that it shows water and reacts to keys and the mouse.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const SIZE: [u32; 2] = [720, 480];
const TOOLS: [(&str, &str); 3] = [("Xvfb", "-help"), ("xdotool", "version"), ("import", "-version")];

/// Kills the process when dropped.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

struct Screen {
    display: String,
    _server: Running,
}

impl Screen {
    fn open() -> Self {
        let mut server = Command::new("Xvfb");
        server.args(["-displayfd", "1", "-screen", "0", &format!("{}x{}x24", SIZE[0], SIZE[1])]);
        let mut server = Running(server.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap());
        let mut number = String::new();
        BufReader::new(server.0.stdout.take().unwrap()).read_line(&mut number).unwrap();
        Self { display: format!(":{}", number.trim()), _server: server }
    }

    fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.env("DISPLAY", &self.display).stderr(Stdio::null());
        command
    }

    /// The output of xdotool.
    fn tool(&self, arguments: &[&str]) -> String {
        let output = self.command("xdotool").args(arguments).output().unwrap();
        String::from_utf8_lossy(&output.stdout).trim().to_owned()
    }

    /// Rows of RGB.
    fn picture(&self) -> Vec<[u8; 3]> {
        let output =
            self.command("import").args(["-window", "root", "-depth", "8", "rgb:-"]).output().unwrap();
        let pixels = output.stdout.as_chunks::<3>().0.to_vec();
        assert_eq!(pixels.len(), (SIZE[0] * SIZE[1]) as usize);
        pixels
    }

    /// Waits until the picture satisfies the condition.
    fn until(&self, what: &str, wanted: impl Fn(&[[u8; 3]]) -> bool) -> Vec<[u8; 3]> {
        let begun = Instant::now();
        loop {
            let picture = self.picture();
            if wanted(&picture) {
                return picture;
            }
            assert!(begun.elapsed() < Duration::from_secs(60), "{what} did not appear");
            std::thread::sleep(Duration::from_millis(200));
        }
    }
}

/// The left part of the picture, which contains the water but no panels: the numbers in panels change.
fn water(picture: &[[u8; 3]]) -> impl Iterator<Item = [u8; 3]> {
    let [width, height] = SIZE.map(|side| side as usize);
    let inside = move |i: &usize| {
        let (x, y) = (i % width, i / width);
        (10..width / 2).contains(&x) && (height / 4..height - 60).contains(&y)
    };
    (0..width * height).filter(inside).map(|i| picture[i])
}

/// Fraction of pixels with the blue of water.
fn blue(picture: &[[u8; 3]]) -> f64 {
    let (mut blue, mut all) = (0, 0);
    for [r, _, b] in water(picture) {
        blue += u32::from(b > r.saturating_add(50));
        all += 1;
    }
    f64::from(blue) / f64::from(all)
}

/// Fraction of pixels that differ visibly.
fn differing(a: &[[u8; 3]], b: &[[u8; 3]]) -> f64 {
    let (mut differing, mut all) = (0, 0);
    for (a, b) in water(a).zip(water(b)) {
        differing += u32::from(a.iter().zip(b).any(|(a, b)| a.abs_diff(b) > 12));
        all += 1;
    }
    f64::from(differing) / f64::from(all)
}

#[test]
fn the_window_shows_water_and_reacts() {
    let is_installed = |(tool, argument): &(&str, &str)| {
        Command::new(tool).arg(argument).stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok()
    };
    if let Some((tool, _)) = TOOLS.iter().find(|tool| !is_installed(tool)) {
        let _ = writeln!(
            std::io::stderr(),
            "SKIPPED: the_window_shows_water_and_reacts: {tool} is not installed"
        );
        return;
    }
    let screen = Screen::open();
    let empty = screen.picture();
    assert_eq!(blue(&empty), 0.0);
    let begun = Instant::now();
    let folder = tempfile::tempdir().unwrap();
    let mut program = screen.command(env!("CARGO_BIN_EXE_splashdown"));
    program.args(["view", "dam-break-small", "--size", &format!("{}x{}", SIZE[0], SIZE[1])]);
    // The list of recent files is that of this test.
    program.env("XDG_STATE_HOME", folder.path());
    let _program = Running(program.current_dir(&folder).stdout(Stdio::null()).spawn().unwrap());
    screen.until("the window", |picture| differing(picture, &empty) > 0.5);
    let window = screen.tool(&["search", "--name", "Splashdown"]);
    screen.tool(&["windowfocus", window.lines().last().unwrap()]);
    // Slow particles are blue; clear water is not.
    screen.tool(&["key", "1"]);
    let first = screen.until("water", |picture| blue(picture) > 0.03);
    let opened = begun.elapsed();
    assert!(opened < Duration::from_secs(30), "the first picture came after {opened:?}");
    // The water moves.
    screen.until("motion", |picture| differing(picture, &first) > 0.01);
    // Paused, the picture stays the same: the control for all differences here.
    screen.tool(&["key", "space"]);
    std::thread::sleep(Duration::from_secs(2));
    let paused = screen.picture();
    std::thread::sleep(Duration::from_secs(1));
    assert!(differing(&paused, &screen.picture()) < 0.001, "the paused picture changes");
    // Another display mode.
    screen.tool(&["key", "2"]);
    let liquid = screen.until("the liquid", |picture| differing(picture, &paused) > 0.02);
    // Orbiting, slowly: a drag within one frame would be a click.
    for step in ["mousemove 120 200", "mousedown 1", "mousemove 150 210", "mousemove 180 220", "mouseup 1"] {
        screen.tool(&step.split(' ').collect::<Vec<_>>());
        std::thread::sleep(Duration::from_millis(400));
    }
    screen.until("a different view", |picture| differing(picture, &liquid) > 0.05);
    // The scene is exported, and the command line accepts it.
    screen.tool(&["key", "ctrl+s"]);
    let exported = folder.path().join("dam-break-small.toml");
    let begun = Instant::now();
    while !exported.exists() {
        assert!(begun.elapsed() < Duration::from_secs(20), "no scene was exported");
        std::thread::sleep(Duration::from_millis(100));
    }
    let check = Command::new(env!("CARGO_BIN_EXE_splashdown")).arg("check").arg(&exported).output().unwrap();
    assert!(check.status.success(), "{}", String::from_utf8_lossy(&check.stderr));
}
