//! The files of an animated scene in progress.
//!
//! USD and glTF both consist of arrays and a description of them. The arrays are appended to a data file (`stage::spool`)
//! while the run continues; a file is its copy with the description added. The arrays carry headers, which the readers of
//! the formats do not see. By these a resumed run continues the data file, and also a complete file.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::atomic;
use crate::data::{Mesh, Particles};
use crate::error::IoError;
use crate::stage::{Channel, Found, Pose, Sample, Shape, Signature, Spool, Stage, extent};
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
    has_failed: AtomicBool,
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
    /// Later frames are removed. `None` if there is no series of the same objects that has this frame. Kept data of other objects is renamed to
    /// `STEM.scenepart.old`.
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
        let spool = file.earlier(last).map_err(|error| file.failed(&error))?;
        let Some(spool) = spool else { return Ok(None) };
        *file.spool() = Some(spool);
        Ok(Some(file))
    }

    /// The data of an earlier process up to the frame `last`. Kept data of another scene is set aside, as `.old`.
    fn earlier(&self, last: u32) -> io::Result<Option<Spool>> {
        let text = self.signature();
        let scene = Signature { text: &text, objects: self.stage.objects.len() };
        if let Some(part) = self.part.as_ref().filter(|part| part.is_file()) {
            if let Some(spool) = Spool::continued(part, scene, last)? {
                return Ok(Some(spool));
            }
            fs::rename(part, part.with_extension(format!("{PART_ENDING}.old")))?;
        }
        // The data of both formats is the same, whichever is requested now.
        let endings = ["usdc", "glb"].into_iter();
        let paths = self
            .paths
            .first()
            .into_iter()
            .flat_map(|path| endings.clone().map(|ending| path.with_extension(ending)));
        for path in paths {
            let Some((mut file, start)) = data_of(&path)? else { continue };
            let Some(found) = Found::scan(&mut file, start, scene, last)? else { continue };
            let mut spool = self.new_spool()?;
            spool.copy_from(&mut file, found)?;
            spool.flush()?;
            return Ok(Some(spool));
        }
        Ok(None)
    }

    fn new(paths: Vec<PathBuf>, stage: Stage, keep: Option<&Path>) -> Result<Self, IoError> {
        for path in &paths {
            Encoding::of(path)?;
        }
        let stem = paths.first().and_then(|path| path.file_stem()).unwrap_or_default().to_string_lossy();
        let part = keep.map(|folder| folder.join(format!("{stem}.{PART_ENDING}")));
        Ok(Self { stage, paths, part, spool: Mutex::new(None), has_failed: AtomicBool::new(false) })
    }

    fn create(&self) -> io::Result<Spool> {
        let mut spool = self.new_spool()?;
        let text = self.signature();
        spool.append((0, Channel::Signature), 0, text.len(), text.as_bytes())?;
        Ok(spool)
    }

    fn new_spool(&self) -> io::Result<Spool> {
        match &self.part {
            Some(part) => Spool::kept(part),
            None => Spool::temporary(self.paths.first().map(PathBuf::as_path).unwrap_or(Path::new(""))),
        }
    }

    /// The frame rate and the kinds and names of the objects, by which data of the same scene is recognised.
    fn signature(&self) -> String {
        let mut text = format!("1 {}", self.stage.frames_per_second);
        for object in &self.stage.objects {
            let kind = match &object.shape {
                Shape::Surface => "surface",
                Shape::Points { .. } => "points",
                Shape::Solid(_) => "solid",
                Shape::Camera { .. } => "camera",
            };
            text.push_str(&format!("\n{kind} {}", object.name.replace('\n', " ")));
        }
        text
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
                Sample::Pose(_) | Sample::View { .. } => {}
            }
        }
        let mut state = self.spool();
        if self.has_failed.load(Ordering::Relaxed) {
            return Err(self.failed(&io::Error::other("an earlier frame could not be written")));
        }
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
        attempt().map_err(|error| {
            // What was written of the frame is unknown, so no other can follow it.
            self.has_failed.store(true, Ordering::Relaxed);
            self.failed(&error)
        })
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
    /// A `glb` file holds at most 4 GB. If the frames need more, it contains the first of them, the error
    /// [`IoError::TooLong`] says so, and all frames are written as `usdc`.
    pub fn finish(&self) -> Vec<Result<(PathBuf, u64), IoError>> {
        // The data is taken, so that a temporary file is removed even on failure. A kept one remains on failure.
        let Some(spool) = self.spool().take().filter(|spool| spool.frames().is_some()) else {
            return Vec::new();
        };
        let mut written: Vec<_> = self.paths.iter().map(|path| self.write(path, &spool)).collect();
        let is_usd = |path: &PathBuf| Encoding::of(path) == Ok(Encoding::Usd);
        if let Some(long) = written.iter().position(|file| matches!(file, Err(IoError::TooLong { .. })))
            && !self.paths.iter().any(is_usd)
        {
            written.push(self.write(&self.paths[long].with_extension("usdc"), &spool));
        }
        if written.iter().all(|file| file.is_ok() || matches!(file, Err(IoError::TooLong { .. }))) {
            self.remove_part();
        }
        written
    }

    fn write(&self, path: &Path, spool: &Spool) -> Result<(PathBuf, u64), IoError> {
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
            array(Channel::Extent, extent_of(vertices).len(), bytemuck::cast_slice(&extent_of(vertices)))?;
            array(Channel::Positions, vertices.len(), bytemuck::cast_slice(vertices))?;
            array(Channel::Normals, normals.len(), bytemuck::cast_slice(normals))?;
            array(Channel::Velocities, velocities.len(), bytemuck::cast_slice(velocities))?;
            array(Channel::Corners, 3 * triangles.len(), bytemuck::cast_slice(triangles))
        }
        Sample::Points(particles) => {
            let Particles { ids, positions, velocities, densities, pressures, .. } = &**particles;
            let ids: Vec<i64> = ids.iter().copied().map(i64::from).collect();
            array(Channel::Extent, extent_of(positions).len(), bytemuck::cast_slice(&extent_of(positions)))?;
            array(Channel::Positions, positions.len(), bytemuck::cast_slice(positions))?;
            array(Channel::Velocities, velocities.len(), bytemuck::cast_slice(velocities))?;
            array(Channel::Ids, ids.len(), bytemuck::cast_slice(&ids))?;
            array(Channel::Densities, densities.len(), bytemuck::cast_slice(densities))?;
            array(Channel::Pressures, pressures.len(), bytemuck::cast_slice(pressures))
        }
        Sample::Pose(pose) => array(Channel::Pose, 7, bytemuck::cast_slice(&numbers(*pose))),
        Sample::View { pose, field_of_view, focus } => {
            array(Channel::Pose, 7, bytemuck::cast_slice(&numbers(*pose)))?;
            array(Channel::Lens, 2, bytemuck::cast_slice(&[*field_of_view, *focus]))
        }
    }
}

fn numbers(Pose { position: [x, y, z], orientation: [i, j, k, w] }: Pose) -> [f32; 7] {
    [x, y, z, i, j, k, w]
}

/// The bounding box of points, which nothing has without points.
fn extent_of(points: &[[f32; 3]]) -> Vec<[f32; 3]> {
    if points.is_empty() { Vec::new() } else { extent(points).to_vec() }
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

    /// Data that cannot be continued is kept under another name.
    #[test]
    fn data_of_another_scene_is_set_aside() -> Result<(), IoError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.usdc");
        let keep = Some(folder.path());
        let stage = Stage::of_surface(24.0);
        let killed = StageFile::start(vec![path.clone()], stage.clone(), keep)?;
        (3..5).try_for_each(|number| killed.push(number, &frame(number)))?;
        drop(killed);
        let [part, old] = ["a.scenepart", "a.scenepart.old"].map(|name| folder.path().join(name));
        let bytes = fs::read(&part).unwrap();
        let faster = Stage { frames_per_second: 25.0, ..stage.clone() };
        assert!(StageFile::resume(vec![path.clone()], faster, keep, 4)?.is_none());
        assert!(!part.exists() && fs::read(&old).unwrap() == bytes);
        fs::rename(&old, &part).unwrap();
        let resumed = StageFile::resume(vec![path.clone()], stage, keep, 4)?.unwrap();
        assert!(resumed.finish()[0].is_ok() && path.exists() && !part.exists());
        Ok(())
    }

    /// Points appear in the second frame, and a body moves.
    #[test]
    fn scenes_with_empty_frames_are_written() -> Result<(), IoError> {
        let folder = tempfile::tempdir().unwrap();
        let paths = ["usdc", "glb"].map(|ending| folder.path().join(format!("scene.{ending}")));
        let mut stage = Stage::of_particles(24.0, 0.1);
        let (_, sample) = &frame(1)[0];
        let Sample::Mesh(mesh) = sample else { panic!("no mesh") };
        let body = crate::stage::Object { shape: Shape::Solid(Arc::clone(mesh)), ..stage.objects[0].clone() };
        stage.objects.push(body);
        let file = StageFile::start(paths.to_vec(), stage, None)?;
        for number in 7..10 {
            let points = if number == 7 { Vec::new() } else { vec![[number as f32, 0.0, 0.0]] };
            let points = Sample::Points(Arc::new(Particles::from_positions(points)));
            let pose = Pose { position: [0.0, number as f32, 0.0], ..Pose::IDENTITY };
            file.push(number, &[(0, points), (1, Sample::Pose(pose))])?;
        }
        assert!(file.finish().iter().all(Result::is_ok));
        let bytes = fs::read(&paths[1]).unwrap();
        let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
        let scene: serde_json::Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
        let names: Vec<&str> =
            scene["nodes"].as_array().unwrap().iter().flat_map(|node| node["name"].as_str()).collect();
        assert_eq!(names, ["particles_0008", "particles_0009", "particles", "splashdown"]);
        let input = |channel: usize| {
            let sampler = &scene["animations"][0]["samplers"][channel];
            scene["accessors"][sampler["input"].as_u64().unwrap() as usize].clone()
        };
        // The frame 8 is shown from 1/24 s to 2/24 s, and the body moves during all three frames.
        assert_eq!((input(0)["count"].as_u64(), input(2)["count"].as_u64()), (Some(3), Some(3)));
        assert_eq!((input(0)["min"][0].as_f64(), input(2)["min"][0].as_f64()), (Some(0.0), Some(0.0)));
        Ok(())
    }
}
