//! The files of an animated scene in progress.
//!
//! USD and glTF both consist of arrays and a description of them. The arrays are appended to a data file (`stage::spool`)
//! while the run continues; a file is its copy with the description added. The arrays carry headers, which the readers of
//! the formats do not see. By these a resumed run continues the data file, and also a complete file.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::atomic;
use crate::data::{Mesh, Particles};
use crate::error::IoError;
use crate::stage::{Channel, Pose, Sample, Spool, Stage, extent};
use crate::{gltf, usd};

/// The ending of the data file of a kept series, without its dot.
pub const PART_ENDING: &str = "scenepart";

/// An animated scene to which frames are added. [`StageFile::finish`] writes the files.
#[derive(Debug)]
pub struct StageFile {
    stage: Stage,
    /// The files to write: `.usdc` or `.glb`.
    paths: Vec<PathBuf>,
    /// The data file, if it is to outlive the process.
    part: Option<PathBuf>,
    spool: Mutex<Option<Spool>>,
}

impl StageFile {
    /// Begins files of the same scene, whose endings are `usdc` or `glb`. Until [`StageFile::finish`] the data is in a
    /// temporary file, or, if a folder to `keep` it is given, in a file `STEM.scenepart` from which [`StageFile::resume`]
    /// continues.
    ///
    /// # Errors
    /// [`IoError::UnknownFormat`] for another ending; [`IoError::Write`] if the folder is not writable.
    pub fn start(paths: Vec<PathBuf>, stage: Stage, keep: Option<&Path>) -> Result<Self, IoError> {
        let file = Self::new(paths, stage, keep)?;
        // A kept file is created by the first frame, because a run that cannot start must not replace earlier data.
        if file.part.is_none() {
            *file.spool() = Some(file.create().map_err(|error| file.failed(&error))?);
        }
        Ok(file)
    }

    /// Continues the series of an earlier process after the frame `last`, from its kept data or from a complete file.
    /// Later frames are removed. `None` if there is no series of the same objects that has this frame.
    ///
    /// # Errors
    /// Those of [`StageFile::start`].
    pub fn resume(
        paths: Vec<PathBuf>,
        stage: Stage,
        keep: Option<&Path>,
        last: u32,
    ) -> Result<Option<Self>, IoError> {
        let file = Self::new(paths, stage, keep)?;
        let names = file.names();
        let part = file.part.as_ref().filter(|part| part.is_file());
        let continued = part.and_then(|part| Spool::continued(part, &names, last).ok().flatten());
        let spool = match continued {
            Some(spool) => Some(spool),
            None => file.of_complete(&names, last).map_err(|error| file.failed(&error))?,
        };
        let Some(spool) = spool else { return Ok(None) };
        *file.spool() = Some(spool);
        Ok(Some(file))
    }

    fn new(paths: Vec<PathBuf>, stage: Stage, keep: Option<&Path>) -> Result<Self, IoError> {
        for path in &paths {
            Encoding::of(path)?;
        }
        let stem = paths.first().and_then(|path| path.file_stem()).unwrap_or_default().to_string_lossy();
        let part = keep.map(|folder| folder.join(format!("{stem}.{PART_ENDING}")));
        Ok(Self { stage, paths, part, spool: Mutex::new(None) })
    }

    fn create(&self) -> io::Result<Spool> {
        let path = self.paths.first().map(PathBuf::as_path).unwrap_or(Path::new(""));
        let mut spool = match &self.part {
            Some(part) => Spool::kept(part)?,
            None => Spool::temporary(path)?,
        };
        let names = self.names();
        spool.append((0, Channel::Names), 0, names.len(), names.as_bytes())?;
        Ok(spool)
    }

    /// The data of the first complete file that has the frame.
    fn of_complete(&self, names: &str, last: u32) -> io::Result<Option<Spool>> {
        for path in &self.paths {
            let Some((mut file, start)) = data_of(path)? else { continue };
            let mut spool = match &self.part {
                Some(part) => Spool::kept(part)?,
                None => Spool::temporary(path)?,
            };
            if spool.copy_from(&mut file, start, names, last)? {
                return Ok(Some(spool));
            }
            self.remove_part();
        }
        Ok(None)
    }

    /// The names of the objects, by which data of the same objects is recognised.
    fn names(&self) -> String {
        let names: Vec<String> =
            self.stage.objects.iter().map(|object| object.name.replace('\n', " ")).collect();
        names.join("\n")
    }

    /// Appends a frame: the number of each object with its data. Frames must be appended in the order of their numbers.
    ///
    /// # Errors
    /// Those of [`Mesh::check`] and [`Particles::check`]; [`IoError::Write`].
    pub fn push(&self, frame: u32, samples: &[(usize, Sample)]) -> Result<(), IoError> {
        for (_, sample) in samples {
            match sample {
                Sample::Mesh(mesh) => mesh.check()?,
                Sample::Points(particles) => particles.check()?,
                Sample::Pose(_) => {}
            }
        }
        let mut state = self.spool();
        let mut attempt = || {
            let spool = match &mut *state {
                Some(spool) => spool,
                none => none.insert(self.create()?),
            };
            for (object, sample) in samples {
                append(spool, *object, frame, sample)?;
            }
            spool.append((0, Channel::End), frame, 0, &[])?;
            spool.flush()
        };
        attempt().map_err(|error| self.failed(&error))
    }

    /// Flushes kept data to the disk.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn sync(&self) -> Result<(), IoError> {
        match &mut *self.spool() {
            Some(spool) if self.part.is_some() => spool.sync().map_err(|error| self.failed(&error)),
            _ => Ok(()),
        }
    }

    /// Writes the files; returns the path and size in bytes of each. Without frames there are no files. A second call does
    /// nothing.
    ///
    /// A `glb` file holds at most 4 GB. If the frames need more, it contains the first of them, and the error
    /// [`IoError::TooLong`] says so.
    pub fn finish(&self) -> Vec<Result<(PathBuf, u64), IoError>> {
        // The data is taken, so that a temporary file is removed even on failure. A kept one remains on failure.
        let Some(mut spool) = self.spool().take().filter(|spool| spool.frames().is_some()) else {
            return Vec::new();
        };
        let written: Vec<_> = self.paths.iter().map(|path| self.write(path, &mut spool)).collect();
        if written.iter().all(|file| file.is_ok() || matches!(file, Err(IoError::TooLong { .. }))) {
            self.remove_part();
        }
        written
    }

    fn write(&self, path: &Path, spool: &mut Spool) -> Result<(PathBuf, u64), IoError> {
        let mut blocks = spool.blocks().map_err(|error| IoError::write(path, &error))?;
        let encoding = Encoding::of(path)?;
        let all = blocks.frames();
        if encoding == Encoding::Gltf {
            blocks.truncate(gltf::LARGEST);
        }
        let bytes = atomic::write(path, |out| match encoding {
            Encoding::Usd => usd::write_stage(out, &self.stage, &blocks),
            Encoding::Gltf => gltf::write_stage(out, &self.stage, &blocks),
        })?;
        match (all, blocks.frames()) {
            (Some([_, last]), held) if held.map(|[_, last]| last) != Some(last) => {
                Err(IoError::TooLong { path: path.to_owned(), frame: held.map(|[_, last]| last), last })
            }
            _ => Ok((path.to_owned(), bytes)),
        }
    }

    fn remove_part(&self) {
        if let Some(part) = &self.part {
            // One that cannot be removed is replaced by the next run.
            let _ = fs::remove_file(part);
        }
    }

    fn failed(&self, error: &io::Error) -> IoError {
        let path = self.part.as_ref().or(self.paths.first());
        IoError::write(path.map(PathBuf::as_path).unwrap_or(Path::new("")), error)
    }

    /// Ignores the panic of another thread that held the lock.
    fn spool(&self) -> MutexGuard<'_, Option<Spool>> {
        self.spool.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A format of animated scenes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Encoding {
    Usd,
    Gltf,
}

impl Encoding {
    fn of(path: &Path) -> Result<Self, IoError> {
        match path.extension().and_then(|ending| ending.to_str()) {
            Some("usdc") => Ok(Self::Usd),
            Some("glb") => Ok(Self::Gltf),
            _ => Err(IoError::UnknownFormat { path: path.to_owned(), allowed: vec![".usdc", ".glb"] }),
        }
    }
}

/// A complete file and the position of its data; `None` if it is absent or another file.
fn data_of(path: &Path) -> io::Result<Option<(File, u64)>> {
    let Ok(mut file) = File::open(path) else { return Ok(None) };
    if !file.metadata()?.is_file() {
        return Ok(None);
    }
    let mut start = [0; 20];
    if file.read_exact(&mut start).is_err() {
        return Ok(None);
    }
    let json = u32::from_le_bytes([start[12], start[13], start[14], start[15]]);
    Ok(match &start[..4] {
        b"PXR-" => Some((file, usd::DATA)),
        b"glTF" => Some((file, 28 + u64::from(json))),
        _ => None,
    })
}

fn append(spool: &mut Spool, object: usize, frame: u32, sample: &Sample) -> io::Result<()> {
    let mut array = |channel, count: usize, elements: &[u8]| match count {
        0 => Ok(()),
        _ => spool.append((object, channel), frame, count, elements),
    };
    match sample {
        Sample::Mesh(mesh) => {
            let Mesh { vertices, normals, velocities, triangles, .. } = &**mesh;
            array(Channel::Extent, 2, bytemuck::cast_slice(&extent(vertices)))?;
            array(Channel::Positions, vertices.len(), bytemuck::cast_slice(vertices))?;
            array(Channel::Normals, normals.len(), bytemuck::cast_slice(normals))?;
            array(Channel::Velocities, velocities.len(), bytemuck::cast_slice(velocities))?;
            array(Channel::Corners, 3 * triangles.len(), bytemuck::cast_slice(triangles))
        }
        Sample::Points(particles) => {
            let Particles { ids, positions, velocities, densities, pressures, .. } = &**particles;
            let ids: Vec<i64> = ids.iter().copied().map(i64::from).collect();
            array(Channel::Extent, 2, bytemuck::cast_slice(&extent(positions)))?;
            array(Channel::Positions, positions.len(), bytemuck::cast_slice(positions))?;
            array(Channel::Velocities, velocities.len(), bytemuck::cast_slice(velocities))?;
            array(Channel::Ids, ids.len(), bytemuck::cast_slice(&ids))?;
            array(Channel::Densities, densities.len(), bytemuck::cast_slice(densities))?;
            array(Channel::Pressures, pressures.len(), bytemuck::cast_slice(pressures))
        }
        Sample::Pose(Pose { position: [x, y, z], orientation: [i, j, k, w] }) => {
            array(Channel::Pose, 7, bytemuck::cast_slice(&[*x, *y, *z, *i, *j, *k, *w]))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    fn frame(number: u32) -> Vec<(usize, Sample)> {
        let x = number as f32;
        let mesh = Mesh::new(vec![[x, 0.0, 0.0], [1.0, x, 0.0], [0.0, 1.0, x]], vec![[0, 1, 2]]);
        vec![(0, Sample::Mesh(Arc::new(mesh)))]
    }

    /// A killed process leaves the data; a finished one only its files. Both are continued, to the same bytes.
    #[test]
    fn files_are_continued_after_a_frame() -> Result<(), IoError> {
        let folder = tempfile::tempdir().unwrap();
        let paths = |name: &str| ["usdc", "glb"].map(|ending| folder.path().join(format!("{name}.{ending}")));
        let keep = Some(folder.path());
        let stage = Stage::of_surface(24.0);
        let whole = StageFile::start(paths("whole").to_vec(), stage.clone(), keep)?;
        (0..5).try_for_each(|number| whole.push(number, &frame(number)))?;
        assert!(whole.finish().iter().all(Result::is_ok));

        let killed = StageFile::start(paths("a").to_vec(), stage.clone(), keep)?;
        (0..4).try_for_each(|number| killed.push(number, &frame(number)))?;
        drop(killed);
        assert!(folder.path().join("a.scenepart").exists());
        let resume = |name: &str, last| StageFile::resume(paths(name).to_vec(), stage.clone(), keep, last);
        let other = Stage { objects: Vec::new(), ..stage.clone() };
        assert!(StageFile::resume(paths("a").to_vec(), other, keep, 2)?.is_none(), "other objects");
        assert!(resume("a", 4)?.is_none(), "a frame that is not there");
        for (number, last) in [(3, 2), (4, 3)] {
            let resumed = resume("a", last)?.unwrap();
            (number..5).try_for_each(|number| resumed.push(number, &frame(number)))?;
            assert!(resumed.finish().iter().all(Result::is_ok));
            assert!(!folder.path().join("a.scenepart").exists());
            for [whole, own] in paths("whole").into_iter().zip(paths("a")).map(|(a, b)| [a, b]) {
                assert!(fs::read(&whole).unwrap() == fs::read(&own).unwrap(), "{} {number}", own.display());
            }
        }
        Ok(())
    }

    #[test]
    fn other_endings_are_refused() {
        let started = StageFile::start(vec!["scene.usda".into()], Stage::of_surface(24.0), None);
        assert!(started.unwrap_err().to_string().contains(".usdc, .glb"));
    }
}
