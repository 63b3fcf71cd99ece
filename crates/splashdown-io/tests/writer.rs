//! The background writer: order, failures, and no deadlock.

mod common;

use std::fs;
use std::path::Path;
use std::sync::Arc;

use common::names;
use splashdown_io::{FrameWriter, IoError, Job, Particles, Picture, WriteCause, ply};

fn frame(folder: &Path, number: usize, particles: &Arc<Particles>) -> Vec<Job> {
    ["ply", "vtu"]
        .map(|kind| {
            Job::Particles(folder.join(format!("particles_{number:04}.{kind}")), Arc::clone(particles))
        })
        .into()
}

#[test]
fn frames_arrive_in_order_with_their_sizes() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    let writer = FrameWriter::start().unwrap();
    let particles = Arc::new(common::particles(1000));
    for number in 0..10 {
        writer.submit(frame(folder.path(), number, &particles)).unwrap();
    }
    let picture = Picture { width: 3, height: 2, rgba: (0..24).collect() };
    writer
        .submit(vec![
            Job::Mesh(place("mesh.obj"), Arc::new(common::cube([0.0; 3], 1.0))),
            Job::Png(place("picture.png"), Arc::new(picture.clone())),
            Job::Bytes(place("report.json"), b"{}".to_vec()),
        ])
        .unwrap();
    let files = writer.finish().unwrap();

    assert_eq!(files.len(), 23);
    assert_eq!(names(folder.path()).len(), 23);
    for (number, file) in files[..20].iter().enumerate() {
        let kind = ["ply", "vtu"][number % 2];
        assert_eq!(file.path, place(&format!("particles_{:04}.{kind}", number / 2)));
    }
    for file in &files {
        assert_eq!(file.bytes, fs::metadata(&file.path).unwrap().len());
    }
    assert_eq!(ply::read_particles(&place("particles_0009.ply")).unwrap(), *particles);
    let read = image::open(place("picture.png")).unwrap().to_rgba8();
    assert_eq!((read.width(), read.height(), read.into_raw()), (3, 2, picture.rgba));
}

#[test]
fn after_a_failure_earlier_files_remain_and_every_call_fails() {
    let folder = tempfile::tempdir().unwrap();
    let series = folder.path().join("series");
    fs::create_dir(&series).unwrap();
    let writer = FrameWriter::start().unwrap();
    let particles = Arc::new(common::particles(100));
    writer.submit(frame(&series, 0, &particles)).unwrap();
    while writer.written().len() < 2 {
        std::thread::yield_now();
    }

    // The folder is removed, as if its disk were unplugged, and restored later.
    let aside = folder.path().join("aside");
    fs::rename(&series, &aside).unwrap();
    writer.submit(frame(&series, 1, &particles)).unwrap();
    let error = loop {
        // A call fails sooner or later, and none blocks although nothing is written.
        if let Err(error) = writer.submit(frame(&series, 2, &particles)) {
            break error;
        }
    };
    fs::rename(&aside, &series).unwrap();
    assert!(
        matches!(&error, IoError::Write { cause: WriteCause::MissingFolder, path, .. }
        if path.ends_with("series/particles_0001.ply")),
        "{error}"
    );
    assert_eq!(writer.submit(frame(&series, 3, &particles)).unwrap_err(), error);

    let failure = writer.finish().unwrap_err();
    assert_eq!(failure.error, error);
    assert_eq!(failure.written.len(), 2);
    assert!(failure.lost >= 6 && failure.lost.is_multiple_of(2), "{failure}");
    assert!(failure.to_string().contains("2 files are complete"), "{failure}");
    assert_eq!(names(&series), ["particles_0000.ply", "particles_0000.vtu"]);
    assert_eq!(ply::read_particles(&series.join("particles_0000.ply")).unwrap(), *particles);
}

#[test]
fn dropping_waits_for_submitted_frames() {
    let folder = tempfile::tempdir().unwrap();
    let writer = FrameWriter::start().unwrap();
    let particles = Arc::new(common::particles(20_000));
    for number in 0..4 {
        writer.submit(frame(folder.path(), number, &particles)).unwrap();
    }
    drop(writer);
    assert_eq!(names(folder.path()).len(), 8);
    assert_eq!(ply::read_particles(&folder.path().join("particles_0003.ply")).unwrap(), *particles);
}

#[test]
fn a_picture_of_the_wrong_size_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    for (width, height, bytes) in [(3, 2, 23), (0, 2, 0), (u32::MAX, u32::MAX, 4)] {
        let writer = FrameWriter::start().unwrap();
        let picture = Picture { width, height, rgba: vec![0; bytes] };
        writer.submit(vec![Job::Png(folder.path().join("picture.png"), Arc::new(picture))]).unwrap();
        let failure = writer.finish().unwrap_err();
        assert!(matches!(failure.error, IoError::PictureSize { .. }), "{failure}");
        assert_eq!(failure.lost, 1);
    }
    assert!(names(folder.path()).is_empty());
}
