//! Full disks and folders that are not writable. Existing files remain valid.

mod common;

use std::fs::{self, File};
use std::io::{self, Write};

use common::names;
use splashdown_io::{
    IoError, WriteCause, atomic, obj, ply, prepare_folder, vtu, write_mesh, write_particles,
};

fn cause(error: &IoError) -> Option<WriteCause> {
    if let IoError::Write { cause, .. } = error { Some(*cause) } else { None }
}

/// The device that is always full, if the system has it.
fn full_device() -> Option<File> {
    let device = File::options().write(true).open("/dev/full").ok();
    if device.is_none() {
        eprintln!("SKIPPED: this system has no /dev/full");
    }
    device
}

#[test]
fn a_full_disk_leaves_the_old_file_and_no_partial_file() {
    let Some(mut full) = full_device() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frame.ply");
    fs::write(&path, "the old frame").unwrap();

    let error = atomic::write(&path, |out| {
        out.write_all(&[7; 100_000])?;
        full.write_all(&[7; 100_000])
    })
    .unwrap_err();
    assert_eq!(cause(&error), Some(WriteCause::DiskFull));
    let message = error.to_string();
    assert!(
        message.contains("frame.ply")
            && message.contains("disk is full")
            && message.contains("free some space")
    );
    assert_eq!(names(folder.path()), ["frame.ply"]);
    assert_eq!(fs::read_to_string(&path).unwrap(), "the old frame");

    // Control: without the failure the file is replaced.
    assert_eq!(atomic::write(&path, |out| out.write_all(b"new")).unwrap(), 3);
    assert_eq!(fs::read_to_string(&path).unwrap(), "new");
    assert_eq!(names(folder.path()), ["frame.ply"]);
}

#[test]
fn every_writer_reports_a_full_disk() {
    let Some(mut full) = full_device() else { return };
    let (particles, mesh) = (common::particles(5000), common::torus(1.0, 0.2, 50, 50));
    let results: [io::Result<()>; 4] = [
        ply::write_particles_to(&mut full, &particles),
        vtu::write_particles_to(&mut full, &particles),
        ply::write_mesh_to(&mut full, &mesh),
        obj::write_mesh_to(&mut full, &mesh),
    ];
    for result in results {
        assert_eq!(WriteCause::of(&result.unwrap_err()), WriteCause::DiskFull);
    }
}

#[test]
fn a_path_below_a_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("notes.txt");
    fs::write(&file, "mine").unwrap();
    for place in [file.clone(), file.join("out"), file.join("out/deeper")] {
        let error = prepare_folder(&place).unwrap_err();
        assert_eq!(cause(&error), Some(WriteCause::NotAFolder), "{error}");
        assert!(error.to_string().contains("notes.txt"), "{error}");
    }
    let error = write_particles(&file.join("frame.ply"), &common::particles(3)).unwrap_err();
    assert!(matches!(cause(&error), Some(WriteCause::NotAFolder | WriteCause::MissingFolder)), "{error}");
    assert_eq!(fs::read_to_string(&file).unwrap(), "mine");
}

#[test]
fn a_folder_is_created_with_its_parents_and_left_empty() {
    let folder = tempfile::tempdir().unwrap();
    let deep = folder.path().join("out/dam-break/meshes");
    prepare_folder(&deep).unwrap();
    prepare_folder(&deep).unwrap();
    assert!(names(&deep).is_empty());
}

#[test]
fn errors_name_a_missing_folder_and_a_folder_in_place_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let cube = common::cube([0.0; 3], 1.0);
    let error = write_mesh(&folder.path().join("gone/mesh.obj"), &cube).unwrap_err();
    assert_eq!(cause(&error), Some(WriteCause::MissingFolder));
    assert!(error.to_string().contains("create the folder"), "{error}");

    let taken = folder.path().join("mesh.ply");
    fs::create_dir(&taken).unwrap();
    let error = write_mesh(&taken, &cube).unwrap_err();
    assert!(error.to_string().contains("mesh.ply"), "{error}");
    assert_eq!(names(folder.path()), ["mesh.ply"]);
}

#[cfg(unix)]
#[test]
fn a_folder_without_permission_is_refused() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o555)).unwrap();
    match prepare_folder(folder.path()) {
        Ok(()) => eprintln!("SKIPPED: the superuser can write to any folder"),
        Err(error) => assert_eq!(cause(&error), Some(WriteCause::Permission), "{error}"),
    }
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_system_without_files_is_refused() {
    if std::path::Path::new("/proc/self").exists() {
        let message = prepare_folder(std::path::Path::new("/proc/splashdown")).unwrap_err().to_string();
        assert!(message.contains("/proc/splashdown"), "{message}");
    }
}

#[test]
fn inconsistent_data_is_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let mut bad = common::particles(10);
    bad.pressures.pop();
    for name in ["a.ply", "a.vtu"] {
        assert!(matches!(write_particles(&folder.path().join(name), &bad), Err(IoError::Length { .. })));
    }
    assert_eq!(
        vtu::write_particles_to(&mut Vec::new(), &bad).unwrap_err().kind(),
        io::ErrorKind::InvalidInput
    );
    let mut bad = common::cube([0.0; 3], 1.0);
    bad.triangles[3][0] = 99;
    for name in ["a.ply", "a.obj"] {
        assert!(matches!(write_mesh(&folder.path().join(name), &bad), Err(IoError::IndexOutOfRange { .. })));
    }
    assert!(names(folder.path()).is_empty());
}
