//! `splashdown render`: finished runs drawn again, complete or not.

use std::fs;
use std::path::Path;
use std::process::{Output, Stdio};
use std::time::{Duration, Instant};

use crate::place::{Outcome, Place, assert_refused, can_draw, names, stderr, stdout};

/// The small scene with a body that flies, in three frames of PLY files. Without a caption, pictures differ only by what moves.
fn finished(place: &Place) -> Outcome {
    let scene = fs::read_to_string(place.path("small.toml"))?;
    let scene =
        scene.replace("duration = 0.01", "duration = 0.04").replace("frame_rate = 200", "frame_rate = 50");
    let more = "\n[picture]\ncaption = \"\"\n[[body]]\nname = \"ball\"\nmesh = \"sphere\"\nscale = 0.2\n\
        position = [0.7, 0.6, 0.15]\nmotion = \"dynamic\"\nvelocity = [-1, 0, 0]\n";
    place.write("small.toml", scene + more)?;
    let output = place.run_small(&["--formats", "ply"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    Ok(())
}

fn render(place: &Place, more: &[&str]) -> std::io::Result<Output> {
    place.splashdown(&[&["render", "out", "--quality", "interactive"], more].concat()).output()
}

fn truncate(path: &Path) -> std::io::Result<()> {
    let bytes = fs::read(path)?;
    fs::write(path, &bytes[..bytes.len() / 2])
}

/// The pictures in a folder.
fn pictures(place: &Place, folder: &str) -> std::io::Result<Vec<Vec<u8>>> {
    let names = names(&place.path(folder))?.into_iter().filter(|name| name.ends_with(".png"));
    names.map(|name| fs::read(place.path(folder).join(name))).collect()
}

/// A film exists unless the output says why not.
fn assert_film(place: &Place, folder: &str, output: &Output) {
    let exists = place.path(folder).join("film.mp4").exists();
    assert!(exists || stderr(output).contains("ffmpeg"), "{}", stderr(output));
}

#[test]
fn damaged_files_leave_out_their_frame_or_their_part() -> Outcome {
    if !can_draw() {
        return Ok(());
    }
    let place = Place::new()?;
    finished(&place)?;
    let output = render(&place, &["-o", "whole"])?;
    assert!(output.status.success() && !stderr(&output).contains("warning"), "{}", stderr(&output));
    let whole = pictures(&place, "whole")?;
    assert_eq!(whole.len(), 3);

    truncate(&place.path("out/mesh/surface_0001.ply"))?;
    truncate(&place.path("out/particles/particles_0002.ply"))?;
    let output = render(&place, &["-o", "damaged"])?;
    assert!(output.status.success(), "{}", stderr(&output));
    let damaged = pictures(&place, "damaged")?;
    assert!(damaged == [whole[0].clone(), whole[2].clone()], "the other frames are drawn as before");
    assert_film(&place, "damaged", &output);
    for words in ["frame 1 is left out: ", "frame 2 is drawn without a file: "] {
        assert_eq!(stderr(&output).matches(words).count(), 1, "{}", stderr(&output));
    }
    assert!(stdout(&output).starts_with("2 pictures"), "{}", stdout(&output));

    // A table that is too short: the body is drawn where it was last. Without its table it is not drawn.
    let table = place.path("out/bodies/ball.csv");
    let rows: Vec<String> = fs::read_to_string(&table)?.lines().map(str::to_owned).collect();
    fs::write(&table, rows[..2].join("\n"))?;
    fs::copy(place.path("out/mesh/surface_0002.ply"), place.path("out/mesh/surface_0040.ply"))?;
    let output = render(&place, &["-o", "short", "-f", "2.."])?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stderr(&output).contains("nearest known place in frames 2, 40"), "{}", stderr(&output));
    assert_eq!(pictures(&place, "short")?.len(), 2);
    fs::write(&table, "time (s),nothing\n")?;
    let output = render(&place, &["-o", "without", "-f", "0"])?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stderr(&output).contains("the body \"ball\" is not shown"), "{}", stderr(&output));
    assert!(pictures(&place, "without")? != whole[..1], "control: the body was visible before");

    // Control: without a single frame it is an error, and no empty folder remains.
    for frame in [0, 2, 40] {
        truncate(&place.path(&format!("out/mesh/surface_{frame:04}.ply")))?;
    }
    let output = render(&place, &["-o", "nothing"])?;
    assert_refused(&output, 3, &["surface_0000.ply"]);
    assert!(!place.path("nothing").exists());
    Ok(())
}

#[test]
fn a_run_is_drawn_from_anywhere_as_it_was() -> Outcome {
    if !can_draw() {
        return Ok(());
    }
    let place = Place::new()?;
    finished(&place)?;
    assert!(render(&place, &["-f", "1", "-o", "here"])?.status.success());
    // The scene file changes its camera, and disappears.
    let scene = fs::read_to_string(place.path("small.toml"))?;
    place.write("other.toml", format!("{scene}[camera]\nazimuth = 120\n"))?;
    fs::rename(place.path("small.toml"), place.path("kept.toml"))?;
    fs::rename(place.path("out"), place.path("moved"))?;
    let elsewhere = tempfile::tempdir()?;
    let draw = |more: &[&str]| {
        let mut command = place.splashdown(&["render", "--quality", "interactive", "-f", "1"]);
        command.arg(place.path("moved")).args(more).current_dir(elsewhere.path()).output()
    };
    let output = draw(&[])?;
    assert!(output.status.success(), "{}", stderr(&output));
    let here = pictures(&place, "here")?;
    assert_eq!(here.len(), 1);
    assert!(pictures(&place, "moved/render")? == here, "the same scene");
    // Control: another scene gives another picture.
    let other = place.path("other.toml").display().to_string();
    let output = draw(&["--scene", &other])?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(pictures(&place, "moved/render-2")? != here);
    Ok(())
}

#[test]
fn slow_motion_shows_moments_between_the_frames() -> Outcome {
    if !can_draw() {
        return Ok(());
    }
    let place = Place::new()?;
    finished(&place)?;
    for more in
        [&["-o", "fast"][..], &["-o", "slow", "--slow", "2"], &["-o", "one", "-f", "1", "--slow", "2"]]
    {
        let output = render(&place, more)?;
        assert!(output.status.success(), "{}", stderr(&output));
    }
    let (fast, slow) = (pictures(&place, "fast")?, pictures(&place, "slow")?);
    assert_eq!((fast.len(), slow.len()), (3, 5));
    for frame in 0..3 {
        assert!(slow[2 * frame] == fast[frame], "frame {frame} is drawn as it is");
    }
    for between in [1, 3] {
        assert!(
            slow[between] != slow[between - 1] && slow[between] != slow[between + 1],
            "picture {between}"
        );
    }
    // A single picture has no film.
    assert_eq!(names(&place.path("one"))?, ["picture_0000.png"]);
    // Without particles the velocities are those of the meshes.
    fs::remove_dir_all(place.path("out/particles"))?;
    let output = render(&place, &["-o", "meshes", "--slow", "2"])?;
    assert!(output.status.success() && !stderr(&output).contains("velocities"), "{}", stderr(&output));
    let slow = pictures(&place, "meshes")?;
    assert!(slow[1] != slow[0] && slow[1] != slow[2]);
    Ok(())
}

#[test]
fn a_film_is_repeated() -> Outcome {
    if !can_draw() {
        return Ok(());
    }
    let place = Place::new()?;
    finished(&place)?;
    let mut sizes = Vec::new();
    for (folder, times) in [("once", "1"), ("often", "20")] {
        let output = render(&place, &["-o", folder, "--loop", times, "--turn", "40"])?;
        assert!(output.status.success(), "{}", stderr(&output));
        assert_film(&place, folder, &output);
        assert_eq!(pictures(&place, folder)?.len(), 3);
        sizes.extend(fs::metadata(place.path(folder).join("film.mp4")).map(|data| data.len()));
    }
    assert!(sizes.is_empty() || sizes[1] > 2 * sizes[0], "{sizes:?}");
    assert_refused(&render(&place, &["--loop", "0"])?, 2, &["--loop", "1 to 1000"]);
    Ok(())
}

#[test]
fn particles_are_drawn_again_in_other_colours() -> Outcome {
    if !can_draw() {
        return Ok(());
    }
    let place = Place::new()?;
    finished(&place)?;
    let draw = |folder: &str, more: &[&str]| -> Result<Vec<u8>, Box<dyn std::error::Error>> {
        let output = render(&place, &[&["-f", "2", "-o", folder], more].concat())?;
        assert!(output.status.success(), "{}", stderr(&output));
        Ok(pictures(&place, folder)?.pop().ok_or("no picture")?)
    };
    let speed = draw("speed", &["--pictures", "particles"])?;
    let pressure = draw("pressure", &["--colour-by", "pressure"])?;
    assert!(speed != pressure && speed != draw("surface", &[])?);
    let refused = render(&place, &["--pictures", "surface", "--colour-by", "speed"])?;
    assert_refused(&refused, 2, &["--pictures particles"]);
    // A run without meshes shows its particles.
    fs::remove_dir_all(place.path("out/mesh"))?;
    assert!(draw("only", &[])? == speed);
    assert_refused(&render(&place, &["--pictures", "surface"])?, 3, &["no meshes", "draw the particles"]);
    Ok(())
}

#[test]
fn the_camera_follows_a_path() -> Outcome {
    if !can_draw() {
        return Ok(());
    }
    let place = Place::new()?;
    finished(&place)?;
    place.write(
        "path.toml",
        "[[keyframe]]\ntime = 0\neye = [1.5, 0.5, 1.5]\ntarget = [0.2, 0.2, 0.15]\n\
         [[keyframe]]\ntime = 0.04\ndistance = 1\nazimuth = 90\nelevation = 5\nfield_of_view = 60\n",
    )?;
    for more in [&["-o", "still"][..], &["-o", "moving", "--camera-path", "path.toml"]] {
        let output = render(&place, more)?;
        assert!(output.status.success(), "{}", stderr(&output));
    }
    let (still, moving) = (pictures(&place, "still")?, pictures(&place, "moving")?);
    assert!(still.iter().zip(&moving).all(|(a, b)| a != b));
    // The same path in the scene of the run.
    let scene = fs::read_to_string(place.path("small.toml"))?;
    let path = fs::read_to_string(place.path("path.toml"))?.replace("[[keyframe]]", "[[camera.keyframe]]");
    place.write("moving.toml", format!("{scene}{path}"))?;
    let output = render(&place, &["-o", "scene", "--scene", "moving.toml"])?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(pictures(&place, "scene")? == moving);
    place.write("wrong.toml", "[[keyframe]]\ntime = 1\nspeed = 2\n[[keyframe]]\ntime = 0.5\n")?;
    let refused = render(&place, &["--camera-path", "wrong.toml"])?;
    assert_refused(
        &refused,
        3,
        &["wrong.toml", "keyframe[0].speed", "keyframe[1].time = 0.5 s is not after"],
    );
    assert_refused(&render(&place, &["--camera-path", "none.toml"])?, 3, &["none.toml"]);
    Ok(())
}

#[test]
#[cfg(unix)]
fn ctrl_c_finishes_the_film_of_the_pictures_so_far() -> Outcome {
    if !can_draw() {
        return Ok(());
    }
    let place = Place::new()?;
    finished(&place)?;
    let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin!("splashdown"));
    command.args(["render", "out", "--slow", "100", "-o", "film"]).current_dir(place.path("."));
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;
    let begun = Instant::now();
    while !place.path("film/picture_0001.png").exists() {
        assert!(begun.elapsed() < Duration::from_secs(60), "no pictures");
        std::thread::sleep(Duration::from_millis(5));
    }
    let killed = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status()?;
    assert!(killed.success());
    let output = child.wait_with_output()?;
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    let count = pictures(&place, "film")?.len();
    assert!((2..201).contains(&count), "{count} pictures");
    assert!(stdout(&output).contains(&format!("Stopped after {count} of 201")), "{}", stdout(&output));
    assert_film(&place, "film", &output);
    Ok(())
}
