//! The frames of a finished run, read from its folder to be drawn again.

use std::path::Path;
use std::sync::Arc;

use splashdown::BodyState;
use splashdown::scene::{PictureKind, Scene};
use splashdown_io::{Mesh, Particles, Picture};

use super::draw::FrameRenderer;
use super::droplets::with_droplets;
use super::known_bodies::KnownBodies;
use super::motion::{advanced, is_blurred, with_velocities_of};
use super::orbit::Orbit;
use super::{FrameData, drawing_device};
use crate::{PictureTimings, PlayedFrame, RunError, RunFrames};

/// Draws surfaces or particles from the files of a finished or interrupted run.
///
/// Files that are missing or damaged are problems and not errors, as in playback ([`RunFrames`]): what exists of a frame is
/// drawn. Only a frame without the liquid cannot be read.
pub struct FinishedRun {
    frames: RunFrames,
    kind: PictureKind,
    renderer: FrameRenderer,
    /// Which of the bodies with a known place have a mesh.
    has_mesh: Vec<bool>,
    /// Whether frames are drawn between those of the run.
    is_slowed: bool,
    problems: Vec<String>,
}

/// A frame of a finished run, as it is drawn.
#[derive(Debug)]
pub struct FinishedFrame {
    data: FrameData,
    moves: bool,
    problems: Vec<String>,
}

impl FinishedFrame {
    /// Files that cannot be read, and why. The frame is drawn without them.
    pub fn problems(&self) -> &[String] {
        &self.problems
    }

    /// Whether the velocities of the liquid are known, so that it can be drawn at times near that of the frame.
    pub fn moves(&self) -> bool {
        self.moves
    }
}

impl std::fmt::Debug for FinishedRun {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FinishedRun").field("frames", &self.frames).field("kind", &self.kind).finish()
    }
}

impl FinishedRun {
    /// Opens the folder of a run to draw its surfaces. `scene` is that of the run, whose camera, appearance and output may be
    /// changed.
    ///
    /// # Errors
    /// As [`open_for`](Self::open_for).
    pub fn open(folder: &Path, scene: &Scene) -> Result<Self, RunError> {
        Self::open_for(folder, scene, PictureKind::Surface)
    }

    /// As [`open`](Self::open), to draw surfaces or particles.
    ///
    /// # Errors
    /// [`RunError::Input`] if there are no files for pictures of this kind; [`RunError::Gpu`] without a driver;
    /// [`RunError::Render`] if the device cannot draw pictures of the scene's size.
    pub fn open_for(folder: &Path, scene: &Scene, kind: PictureKind) -> Result<Self, RunError> {
        let wanted = match kind {
            PictureKind::Surface => {
                "meshes that can be read (mesh/surface_0000.ply, ...): give the output folder of a run with meshes as PLY, \
                 OBJ, STL or GLB, or draw the particles"
            }
            PictureKind::Particles => {
                "particles that can be read (particles/particles_0000.ply, ...): give the output folder of a run with \
                 particles, or draw the surface"
            }
        };
        let nothing = || RunError::Input(format!("`{}` contains no {wanted}", folder.display()));
        if !RunFrames::exist_in(folder) {
            return Err(nothing());
        }
        let frames = RunFrames::open(folder, Some(scene.clone()))?;
        if frames.numbers_with(kind).next().is_none() {
            return Err(nothing());
        }
        let KnownBodies { meshes, has_mesh, problems } = KnownBodies::of(&frames);
        let renderer = FrameRenderer::new(drawing_device(None)?, scene, &meshes, vec![kind])?;
        Ok(Self { frames, kind, renderer, has_mesh, is_slowed: false, problems })
    }

    /// Draws frames between those of the run from now on: `factor` pictures per frame. The shutter is open for a shorter
    /// time accordingly.
    pub fn slow_down(&mut self, factor: f32) {
        self.is_slowed = true;
        self.renderer.shorten_exposure(factor);
    }

    /// Measures the passes of the pictures from now on. Returns false if the device has no timestamps.
    pub fn enable_timing(&mut self) -> bool {
        self.renderer.enable_timing()
    }

    /// The times of the passes since the last call.
    pub fn take_timings(&mut self) -> PictureTimings {
        self.renderer.take_timings()
    }

    /// The scene of the run.
    pub fn scene(&self) -> &Scene {
        self.frames.scene()
    }

    /// The numbers of the frames with a file of the liquid, ascending; there is at least one.
    pub fn frames(&self) -> impl Iterator<Item = u32> + Clone {
        self.frames.numbers_with(self.kind)
    }

    /// What is missing beside the liquid in the frames that are `wanted`: foam, meshes and places of bodies.
    pub fn problems(&self, wanted: impl Fn(u32) -> bool) -> Vec<String> {
        let beside = self.frames.problems_beside(wanted);
        self.problems.iter().cloned().chain(beside).collect()
    }

    /// Reads a frame.
    ///
    /// # Errors
    /// [`RunError::Input`] if the frame does not exist, or no file of its liquid can be read; [`RunError::Simulation`] if its
    /// particles are too far apart.
    pub fn read(&self, number: u32) -> Result<FinishedFrame, RunError> {
        let mut played = self.frames.read_for(Some(self.kind), number)?;
        let problems = std::mem::take(&mut played.problems);
        let is_empty = played.particles.as_ref().is_some_and(|particles| particles.is_empty());
        let exists = match self.kind {
            PictureKind::Particles => played.particles.is_some(),
            PictureKind::Surface => played.mesh.is_some() || is_empty,
        };
        if !exists {
            let reason =
                if problems.is_empty() { "it has no file to draw".to_owned() } else { problems.join("; ") };
            return Err(RunError::Input(reason));
        }
        let data = self.prepare(played)?;
        let moves = match (&data.mesh, self.kind) {
            (Some(mesh), PictureKind::Surface) => mesh.velocities.len() == mesh.vertices.len(),
            (None, PictureKind::Surface) => true,
            (_, PictureKind::Particles) => data.particles.velocities.len() == data.particles.positions.len(),
        };
        Ok(FinishedFrame { data, moves, problems })
    }

    /// The mesh without isolated particles, with velocities if they are needed, and these particles.
    fn separate(
        &self,
        mesh: Mesh,
        particles: &Particles,
        droplets: Option<&Particles>,
    ) -> Result<(Option<Mesh>, Option<Particles>), RunError> {
        let scene = self.frames.scene();
        let known = droplets.map_or(&[][..], |droplets| &droplets.ids);
        let (mut mesh, separated) = with_droplets(mesh, particles, known, scene)?;
        if is_blurred(scene) || self.is_slowed {
            mesh = with_velocities_of(mesh, particles, scene)?;
        }
        Ok((Some(mesh), separated))
    }

    /// What is drawn of a frame.
    fn prepare(&self, played: PlayedFrame) -> Result<FrameData, RunError> {
        let PlayedFrame { number, time, particles, mesh, droplets, foam, bodies, .. } = played;
        let (mesh, separated) = match (mesh, &particles) {
            (Some(mesh), Some(particles)) => self.separate(mesh, particles, droplets.as_ref())?,
            (mesh, _) => (mesh, None),
        };
        Ok(FrameData {
            index: number,
            time,
            particles: particles.unwrap_or_default().into(),
            mesh: mesh.map(Arc::new),
            // Without particles the droplets are those of the run.
            droplets: separated.or(droplets).map(Arc::new),
            foam: foam.map(Arc::new),
            bodies: self.with_meshes(bodies),
        })
    }

    /// The states of the bodies that have a mesh.
    fn with_meshes(&self, states: Vec<BodyState>) -> Arc<[BodyState]> {
        states.into_iter().zip(&self.has_mesh).filter(|(_, has)| **has).map(|(state, _)| state).collect()
    }

    /// Draws a frame; `progress` is 0 for the first and 1 for the last frame of the film.
    ///
    /// # Errors
    /// As [`read`](Self::read) and [`draw_frame`](Self::draw_frame).
    pub fn draw(&mut self, frame: u32, orbit: &Orbit, progress: f32) -> Result<Arc<Picture>, RunError> {
        let frame = self.read(frame)?;
        self.draw_frame(&frame, 0.0, orbit, progress)
    }

    /// Draws a frame at a time in s relative to that of the frame: liquid, droplets and foam move by their velocities, bodies
    /// and the camera are where they are at that time. `progress` is 0 for the first and 1 for the last picture of the film.
    ///
    /// # Errors
    /// [`RunError::Render`]; [`RunError::Gpu`] if the device was lost.
    pub fn draw_frame(
        &mut self,
        frame: &FinishedFrame,
        offset: f64,
        orbit: &Orbit,
        progress: f32,
    ) -> Result<Arc<Picture>, RunError> {
        let moved = (offset != 0.0).then(|| {
            let time = frame.data.time + offset;
            let bodies = self.with_meshes(self.frames.bodies_at(time));
            advanced(&frame.data, offset, bodies, self.frames.scene())
        });
        let data = moved.as_ref().unwrap_or(&frame.data);
        let camera = orbit.camera(self.frames.scene().camera_at(data.time), progress);
        let pictures = self.renderer.draw_from(data, camera)?;
        pictures.into_iter().next().ok_or_else(|| RunError::Input("no picture was drawn".to_owned()))
    }
}
