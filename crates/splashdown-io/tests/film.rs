//! Films: encoding a film if `ffmpeg` is installed, and every failure of the child process.

mod common;

use std::path::Path;
use std::process::Command;
use std::sync::Arc;

use common::names;
use splashdown_io::{Film, FilmError, FilmOptions, FrameWriter, Job, Picture};

fn options(folder: &Path, width: u32, height: u32) -> FilmOptions {
    let pictures = folder.join("frame_%04d.png").display().to_string();
    FilmOptions::new(folder.join("film.mp4"), width, height, 25.0, pictures)
}

/// A picture of one colour.
fn picture(width: u32, height: u32, colour: [u8; 4]) -> Arc<Picture> {
    Arc::new(Picture { width, height, rgba: colour.repeat((width * height) as usize) })
}

fn has_ffmpeg() -> bool {
    let found = Command::new("ffmpeg").arg("-version").output().is_ok();
    if !found {
        eprintln!("SKIPPED: ffmpeg is not installed");
    }
    found
}

#[test]
fn a_film_has_the_pictures_in_order_and_colour() {
    if !has_ffmpeg() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    // The size is odd in both directions, so the film is padded by a column and a row.
    let film = Arc::new(Film::start(options(folder.path(), 63, 49)).unwrap());
    let colours = [[200, 40, 40, 255], [40, 180, 60, 255], [30, 60, 200, 255], [220, 220, 220, 255]];
    let writer = FrameWriter::start().unwrap();
    for colour in colours {
        writer.submit(vec![Job::Film(Arc::clone(&film), picture(63, 49, colour))]).unwrap();
    }
    assert!(writer.finish().unwrap().is_empty());
    let bytes = film.finish().unwrap();
    assert_eq!(film.finish(), Ok(bytes), "a second call returns the same");
    assert_eq!(names(folder.path()), ["film.mp4"]);
    assert_eq!(bytes, std::fs::metadata(folder.path().join("film.mp4")).unwrap().len());

    let decode =
        ["-loglevel", "error", "-i", "film.mp4", "-vf", "scale=in_color_matrix=bt709", "-f", "rawvideo"];
    let decoded = Command::new("ffmpeg")
        .current_dir(folder.path())
        .args(decode)
        .args(["-pix_fmt", "rgba", "-"])
        .output()
        .unwrap();
    assert_eq!(decoded.stdout.len(), 4 * 64 * 50 * colours.len());
    for (frame, colour) in decoded.stdout.chunks(4 * 64 * 50).zip(colours) {
        let middle = &frame[4 * (64 * 25 + 32)..][..3];
        // Lossy compression with subsampled colour changes a few steps; a wrong matrix changes up to 20 steps for these
        // colours, a wrong order of frames or channels much more.
        for (got, wanted) in middle.iter().zip(colour) {
            assert!(got.abs_diff(wanted) <= 5, "{middle:?} instead of {colour:?}");
        }
    }
}

#[test]
fn a_missing_program_is_reported_with_advice() {
    let folder = tempfile::tempdir().unwrap();
    let missing = FilmOptions { program: folder.path().join("no-ffmpeg"), ..options(folder.path(), 64, 48) };
    let error = Film::start(missing).unwrap_err();
    assert!(matches!(error, FilmError::NotInstalled { .. }));
    let message = error.to_string();
    for needed in [
        "no-ffmpeg",
        "apt install",
        "brew install",
        "winget install",
        "ffmpeg -framerate 25 -i",
        "frame_%04d.png",
    ] {
        assert!(message.contains(needed), "`{needed}` is missing in: {message}");
    }
    assert!(names(folder.path()).is_empty());
}

#[test]
fn the_command_by_hand_makes_the_film() {
    if !has_ffmpeg() || cfg!(windows) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for number in 0..3 {
        let path = folder.path().join(format!("frame_{number:04}.png"));
        splashdown_io::picture::write_png(&path, &picture(31, 20, [90, 120, 200, 255])).unwrap();
    }
    let command = options(folder.path(), 31, 20).command_by_hand();
    let done = Command::new("sh").arg("-c").arg(&command).output().unwrap();
    assert!(done.status.success(), "{command}\n{}", String::from_utf8_lossy(&done.stderr));
    assert!(folder.path().join("film.mp4").exists());
}

#[test]
fn impossible_sizes_and_rates_are_refused() {
    for (width, height, rate) in [(0, 4, 25.0), (4, 0, 25.0), (4, 4, 0.0), (4, 4, f64::NAN), (4, 4, -1.0)] {
        let options = FilmOptions { frame_rate: rate, ..options(Path::new("."), width, height) };
        assert!(matches!(Film::start(options), Err(FilmError::Options { .. })));
    }
}

#[test]
fn a_picture_of_another_size_ends_the_film_without_a_file() {
    if !has_ffmpeg() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let film = Film::start(options(folder.path(), 64, 48)).unwrap();
    film.push(&picture(64, 48, [0; 4]));
    film.push(&picture(48, 64, [0; 4]));
    film.push(&picture(64, 48, [0; 4]));
    let error = film.finish().unwrap_err();
    assert!(matches!(error, FilmError::PictureSize { number: 1, given: (48, 64), .. }), "{error}");
    assert!(names(folder.path()).is_empty());

    let empty = Film::start(options(folder.path(), 64, 48)).unwrap();
    assert_eq!(empty.finish(), Err(FilmError::Empty));
    let dropped = Film::start(options(folder.path(), 64, 48)).unwrap();
    dropped.push(&picture(64, 48, [0; 4]));
    drop((empty, dropped));
    assert!(names(folder.path()).is_empty());
}

#[test]
fn a_film_that_cannot_be_written_reports_the_programs_message() {
    if !has_ffmpeg() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let gone = folder.path().join("gone");
    let nowhere = FilmOptions { path: gone.join("film.mp4"), ..options(folder.path(), 640, 480) };
    let expected =
        |message: &str| message.contains("No such file or directory") && message.contains("frame_%04d.png");
    let message = Film::start(nowhere.clone()).unwrap_err().to_string();
    assert!(expected(&message), "{message}");
    // The folder disappears while the film is made.
    std::fs::create_dir(&gone).unwrap();
    let film = Film::start(nowhere).unwrap();
    std::fs::remove_dir_all(&gone).unwrap();
    // The pictures exceed the capacity of a pipe. A child that has ended must not block this process, nor end it by a
    // signal.
    for _ in 0..20 {
        film.push(&picture(640, 480, [0; 4]));
    }
    let message = film.finish().unwrap_err().to_string();
    assert!(expected(&message), "{message}");
}

/// Child processes that fail in several ways, as shell scripts.
#[cfg(unix)]
mod failing_children {
    use std::os::unix::fs::PermissionsExt;
    use std::path::PathBuf;
    use std::time::Duration;

    use super::*;

    /// A script in place of `ffmpeg`, which claims to support H.264 and then runs `body`.
    fn fake_ffmpeg(folder: &Path, body: &str) -> PathBuf {
        let path = folder.join("ffmpeg");
        let script = format!(
            "#!/bin/sh\ncase \"$*\" in *-encoders*) echo ' V....D libx264 H.264'; exit 0;; esac\n{body}\n"
        );
        std::fs::write(&path, script).unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
        path
    }

    #[test]
    fn a_child_that_fails_is_an_error_with_its_last_message() {
        let folder = tempfile::tempdir().unwrap();
        // It reads a part of the input, prints more than the capacity of a pipe, and exits.
        let body = "head -c 100000 > /dev/null; yes 'so much to say' | head -c 300000 >&2; echo 'the very end' >&2; exit 3";
        let program = fake_ffmpeg(folder.path(), body);
        let film = Film::start(FilmOptions { program, ..options(folder.path(), 640, 480) }).unwrap();
        for _ in 0..10 {
            film.push(&picture(640, 480, [0; 4]));
        }
        let error = film.finish().unwrap_err();
        let FilmError::Died { status, log, .. } = &error else { panic!("{error}") };
        assert!(status.contains('3') && log.ends_with("the very end") && log.len() <= 2000, "{error}");
        assert_eq!(names(folder.path()), ["ffmpeg"]);
    }

    #[test]
    fn a_child_that_exits_early_with_success_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let program = fake_ffmpeg(folder.path(), "head -c 1000 > /dev/null; exit 0");
        let film = Film::start(FilmOptions { program, ..options(folder.path(), 640, 480) }).unwrap();
        for _ in 0..3 {
            film.push(&picture(640, 480, [0; 4]));
        }
        assert!(matches!(film.finish(), Err(FilmError::Died { .. })));
    }

    #[test]
    fn a_child_that_does_not_respond_is_stopped() {
        let folder = tempfile::tempdir().unwrap();
        let program = fake_ffmpeg(folder.path(), "echo 'busy with nothing' >&2; exec sleep 600");
        let stuck = FilmOptions {
            program,
            stall_limit: Duration::from_millis(200),
            ..options(folder.path(), 640, 480)
        };
        // With five pictures it stalls while it receives them, with one when it should end.
        for pictures in [5, 1] {
            let film = Film::start(stuck.clone()).unwrap();
            for _ in 0..pictures {
                film.push(&picture(640, 480, [0; 4]));
            }
            let error = film.finish().unwrap_err();
            assert!(
                matches!(&error, FilmError::Stalled { log, .. } if log.contains("busy with nothing")),
                "{error}"
            );
        }
    }

    #[test]
    fn a_program_without_h264_is_reported() {
        let folder = tempfile::tempdir().unwrap();
        let program = fake_ffmpeg(folder.path(), "");
        std::fs::write(&program, "#!/bin/sh\necho ' V....D mpeg4 MPEG-4'\n").unwrap();
        let error = Film::start(FilmOptions { program, ..options(folder.path(), 64, 48) }).unwrap_err();
        assert!(
            matches!(error, FilmError::NoH264 { .. }) && error.to_string().contains("libx264"),
            "{error}"
        );
    }
}
