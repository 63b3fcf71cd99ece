//! Pictures of the frames, drawn by a thread of its own while the simulation computes the next frame.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, OnceLock};
use std::thread::{self, JoinHandle};

use splashdown::scene::{PictureKind, Scene};
use splashdown::{BodyMesh, BodyState, DiffuseParticles};
use splashdown_gpu::{DeviceRequest, Gpu};
use splashdown_io::{Film, FilmOptions, FrameWriter, IoError, Job, Mesh, Particles, Picture, picture};
use splashdown_render::{
    Colouring, DrawnFoam, DrawnParticles, DrawnSurface, Frame, Liquid, Offscreen, PlacedBody, RenderError,
    Renderer, UploadedBodies, UploadedFoam, UploadedParticles, UploadedSurface,
};
use splashdown_run::stage;

use crate::exit::Failure;
use crate::layout::Layout;

/// Films show at most this many frames per second; a scene with more is shown in slow motion.
const FASTEST_FILM: f32 = 60.0;
/// How fast slow motion is shown.
const SLOW_MOTION_RATE: f32 = 30.0;

/// Frames that wait while one is drawn.
const QUEUE: usize = 1;

/// Draws the frames of a run.
#[derive(Debug)]
pub struct Pictures {
    kinds: Vec<PictureKind>,
    layout: Layout,
    queue: SyncSender<Drawn>,
    thread: JoinHandle<()>,
    failure: Arc<OnceLock<Failure>>,
    films: Vec<Arc<Film>>,
}

/// What a picture is drawn from.
#[derive(Debug)]
struct Drawn {
    index: u32,
    time: f64,
    particles: Arc<Particles>,
    mesh: Option<Arc<Mesh>>,
    foam: Option<Arc<DiffuseParticles>>,
    bodies: Arc<[BodyState]>,
}

/// Opens something to draw with: the simulation's own GPU, else the best adapter there is, a software driver
/// among them.
///
/// # Errors
/// No driver, with what to install.
pub fn drawing_device(own: Option<&Arc<Gpu>>) -> Result<Arc<Gpu>, Failure> {
    match own {
        Some(gpu) => Ok(Arc::clone(gpu)),
        None => Ok(Arc::new(Gpu::open(&DeviceRequest::Auto)?)),
    }
}

/// Starts a film per kind of picture; what stands in the way comes back as words, with the command for later.
pub fn start_films(scene: &Scene, kinds: &[PictureKind], layout: &Layout) -> (Vec<Arc<Film>>, Vec<String>) {
    let [width, height] = scene.output.picture_size;
    let rate = if scene.frame_rate > FASTEST_FILM { SLOW_MOTION_RATE } else { scene.frame_rate };
    let mut films = Vec::new();
    let mut obstacles = Vec::new();
    for &kind in kinds {
        let options =
            FilmOptions::new(layout.film(kind), width, height, rate.into(), layout.picture_pattern(kind));
        let by_hand = options.command_by_hand();
        match Film::start(options) {
            Ok(film) => films.push(Arc::new(film)),
            Err(error) if obstacles.is_empty() => obstacles.push(error.to_string()),
            Err(_) => obstacles.push(format!("and for the other pictures: {by_hand}")),
        }
    }
    (films, obstacles)
}

/// Begins films with the pictures of frames 0 to `last` that are there already; how many are missing comes back.
///
/// # Errors
/// The writer's first failure.
pub fn resume_films(
    films: &[Arc<Film>],
    kinds: &[PictureKind],
    layout: &Layout,
    last: u32,
    writer: &FrameWriter,
) -> Result<u32, IoError> {
    let mut missing = 0;
    for frame in 0..=last {
        for (film, &kind) in films.iter().zip(kinds) {
            let size = [film.options().width, film.options().height];
            match picture::read_png(&layout.picture(kind, frame)) {
                Ok(picture) if [picture.width, picture.height] == size => {
                    writer.submit(vec![Job::Film(Arc::clone(film), Arc::new(picture))])?;
                }
                _ => missing += 1,
            }
        }
    }
    Ok(missing)
}

impl Pictures {
    /// Starts the thread. `films` are one per kind, or none.
    ///
    /// # Errors
    /// [`Exit::Device`](crate::exit::Exit::Device) if the device cannot draw pictures of the scene's size.
    pub fn start(
        gpu: Arc<Gpu>,
        scene: &Scene,
        bodies: &[BodyMesh],
        kinds: Vec<PictureKind>,
        films: Vec<Arc<Film>>,
        layout: &Layout,
        writer: Arc<FrameWriter>,
    ) -> Result<Self, Failure> {
        let mut artist = Artist::new(gpu, scene, kinds.clone(), films.clone(), layout.clone(), writer)?;
        artist.bodies = bodies
            .iter()
            .map(|body| {
                let colour = body.colour.unwrap_or(PlacedBody::COLOUR);
                PlacedBody::new(&body.mesh.vertices, &body.mesh.triangles, colour)
            })
            .collect::<Result<_, _>>()?;
        let (queue, frames) = sync_channel(QUEUE);
        let failure = Arc::new(OnceLock::new());
        let report = Arc::clone(&failure);
        let body = move || {
            if let Err(error) = artist.draw_all(&frames) {
                // Only this thread writes it, once.
                let _ = report.set(error);
            }
        };
        let thread = thread::Builder::new()
            .name("splashdown-pictures".to_owned())
            .spawn(body)
            .map_err(|error| IoError::WriterStopped { reason: error.to_string() })?;
        Ok(Self { kinds, layout: layout.clone(), queue, thread, failure, films })
    }

    /// The names of the pictures of a frame.
    pub fn names(&self, frame: u32) -> Vec<PathBuf> {
        self.kinds.iter().map(|&kind| self.layout.picture(kind, frame)).collect()
    }

    /// Hands a frame over; waits while [`QUEUE`] frames wait.
    pub fn submit(&self, frame: &splashdown::Frame) {
        let drawn = Drawn {
            index: frame.index,
            time: frame.time,
            particles: Arc::clone(&frame.particles),
            mesh: frame.mesh.clone(),
            foam: frame.foam.clone(),
            bodies: Arc::clone(&frame.bodies),
        };
        // A thread that has failed has said why in `failure`.
        let _ = self.queue.send(drawn);
    }

    /// Why no more pictures are drawn.
    pub fn failure(&self) -> Option<&Failure> {
        self.failure.get()
    }

    /// Waits for the last picture; the films still wait for the writer. The failure, if any, comes with them.
    pub fn finish(self) -> (Vec<Arc<Film>>, Option<Failure>) {
        drop(self.queue);
        let panicked = self.thread.join().is_err();
        let failure = Arc::into_inner(self.failure).and_then(OnceLock::into_inner);
        let stopped = || IoError::WriterStopped { reason: "drawing ended by a panic".to_owned() }.into();
        (self.films, failure.or_else(|| panicked.then(stopped)))
    }
}

/// Lives on the thread.
struct Artist {
    gpu: Arc<Gpu>,
    scene: Scene,
    kinds: Vec<PictureKind>,
    films: Vec<Arc<Film>>,
    layout: Layout,
    writer: Arc<FrameWriter>,
    renderer: Renderer,
    target: Offscreen,
    colouring: Colouring,
    liquid: Liquid,
    bodies: Vec<PlacedBody>,
}

impl Artist {
    fn new(
        gpu: Arc<Gpu>,
        scene: &Scene,
        kinds: Vec<PictureKind>,
        films: Vec<Arc<Film>>,
        layout: Layout,
        writer: Arc<FrameWriter>,
    ) -> Result<Self, Failure> {
        let renderer = Renderer::new(&gpu.device, &gpu.queue, Offscreen::FORMAT, 4)?;
        let target = Offscreen::new(&gpu.device, &gpu.queue, scene.output.picture_size)?;
        let (liquid, colouring) = (stage::liquid(scene), stage::colouring(scene, scene.output.colour_by));
        Ok(Self {
            gpu,
            scene: scene.clone(),
            kinds,
            films,
            layout,
            writer,
            renderer,
            target,
            colouring,
            liquid,
            bodies: Vec::new(),
        })
    }

    /// Draws until the queue is closed.
    fn draw_all(&mut self, frames: &Receiver<Drawn>) -> Result<(), Failure> {
        for drawn in frames {
            let pictures = self.draw(&drawn)?;
            self.gpu.health("a picture")?;
            let mut jobs = Vec::new();
            for (i, (kind, picture)) in self.kinds.iter().zip(pictures).enumerate() {
                jobs.push(Job::Png(self.layout.picture(*kind, drawn.index), Arc::clone(&picture)));
                if let Some(film) = self.films.get(i) {
                    jobs.push(Job::Film(Arc::clone(film), picture));
                }
            }
            // A failure of the writer is the whole run's, and the run reports it.
            if self.writer.submit(jobs).is_err() {
                break;
            }
        }
        Ok(())
    }

    /// One picture per kind; all are under way before the first is waited for.
    fn draw(&mut self, drawn: &Drawn) -> Result<Vec<Arc<Picture>>, RenderError> {
        let device = &self.gpu.device;
        let Particles { positions, velocities, densities, pressures, .. } = &*drawn.particles;
        let particles = match self.kinds.contains(&PictureKind::Particles) {
            true => Some(UploadedParticles::new(device, positions, velocities, densities, pressures)?),
            false => None,
        };
        let surface = match &drawn.mesh {
            Some(mesh) => Some(UploadedSurface::new(device, &mesh.vertices, &mesh.normals, &mesh.triangles)?),
            None => None,
        };
        let foam = match &drawn.foam {
            Some(foam) => {
                let kinds: Vec<u32> = foam.kinds.iter().map(|&kind| kind as u32).collect();
                Some(UploadedFoam::new(device, &foam.positions, &foam.lifetimes, &foam.ids, &kinds)?)
            }
            None => None,
        };
        let placed = self.bodies.iter().zip(&*drawn.bodies);
        let bodies = (!self.bodies.is_empty()).then(|| {
            UploadedBodies::new(
                device,
                placed.map(|(body, state)| (body, state.position.to_array(), state.orientation.to_array())),
            )
        });
        let caption = format!("{}   t = {:.3} s", self.scene.name, drawn.time);
        let radius = self.scene.fluid.particle_radius();
        let mut empty = Frame::new(stage::camera(&self.scene, drawn.time), stage::domain(&self.scene))
            .with_caption(&caption);
        empty.bodies = bodies.as_ref().map(UploadedBodies::buffers);
        empty.foam = foam.as_ref().map(|foam| DrawnFoam::new(foam.buffers(), radius));
        let mut tickets = Vec::new();
        for kind in &self.kinds {
            let mut frame = empty;
            match kind {
                PictureKind::Particles => {
                    frame.particles = particles
                        .as_ref()
                        .map(|particles| DrawnParticles::new(particles.buffers(), radius, self.colouring));
                }
                PictureKind::Surface => {
                    frame.surface =
                        surface.as_ref().map(|surface| DrawnSurface::new(surface.buffers(), self.liquid));
                }
            }
            tickets.push(self.target.submit(&mut self.renderer, &frame)?);
        }
        let [width, height] = self.target.size();
        let collect =
            |ticket| self.target.collect(ticket).map(|rgba| Arc::new(Picture { width, height, rgba }));
        tickets.into_iter().map(collect).collect()
    }
}
