//! Drawing a snapshot into a texture that the window shows.

use std::sync::Arc;

use splashdown::{BodyMesh, BodyState};
use splashdown_gpu::Gpu;
use splashdown_render::{
    Axis, Camera, DrawnLiquidParticles, DrawnParticles, DrawnSlice, DrawnSurface, PassTime, PlacedBody,
    RenderError, Renderer, SurfaceStyle, UploadedBodies,
};
use splashdown_run::appearance;

use crate::engine::Snapshot;
use crate::look::{DisplayMode, Look};
#[cfg(not(target_arch = "wasm32"))]
use crate::pixels;

/// The texture format of egui.
pub(crate) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Draws snapshots.
pub struct Picture {
    gpu: Arc<Gpu>,
    renderer: Renderer,
    target: Option<Target>,
    scene_bodies: Option<SceneBodies>,
    placed: Option<PlacedBodies>,
    timing: bool,
}

struct Target {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    size: [u32; 2],
}

/// The bodies of a scene.
struct SceneBodies {
    /// The meshes from which `bodies` was made.
    meshes: Arc<[BodyMesh]>,
    bodies: Vec<PlacedBody>,
}

/// The bodies at their last positions. Pictures reuse them while no body moves.
struct PlacedBodies {
    states: Vec<BodyState>,
    uploaded: UploadedBodies,
}

impl Picture {
    /// Creates the renderer. Software drivers draw without multisampling, which would dominate their cost.
    ///
    /// # Errors
    /// As [`Renderer::new`].
    pub fn new(gpu: Arc<Gpu>) -> Result<Self, RenderError> {
        let samples = if gpu.is_software() { 1 } else { 4 };
        let renderer = Renderer::new(&gpu.device, &gpu.queue, FORMAT, samples)?;
        Ok(Self { gpu, renderer, target: None, scene_bodies: None, placed: None, timing: false })
    }

    /// Draws into a texture of this size in pixels, limited to the sizes that the device supports.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn draw(
        &mut self,
        size: [u32; 2],
        snapshot: &Snapshot,
        look: &Look,
        camera: Camera,
    ) -> Result<(), RenderError> {
        self.place_bodies(snapshot)?;
        let limit = self.gpu.limits.max_texture_dimension_2d;
        let size = size.map(|side| side.clamp(1, limit));
        if self.target.as_ref().is_none_or(|target| target.size != size) {
            self.target = Some(self.texture(size));
        }
        let Some(target) = &self.target else { return Ok(()) };
        let scene = &snapshot.opened.scene;
        let colouring = appearance::colouring(scene, look.colour_by).with_map(look.map);
        let drawn = &snapshot.drawn;
        let radius = scene.fluid.particle_radius();
        let caption = appearance::own_caption(scene, snapshot.stats.time);
        let mut frame = appearance::empty_frame(scene, camera);
        frame.caption = caption.as_deref();
        frame.bodies = self.placed.as_ref().map(|placed| placed.uploaded.buffers());
        frame.foam = drawn.foam().map(|buffers| appearance::foam(scene, buffers));
        match (look.mode, drawn.mesh()) {
            (DisplayMode::Particles, _) => {
                frame.particles = Some(DrawnParticles::new(drawn.particles(), radius, colouring));
            }
            (DisplayMode::Surface | DisplayMode::Triangles, Some(mesh)) => {
                let style = match look.mode {
                    DisplayMode::Triangles => SurfaceStyle::Lines,
                    _ => SurfaceStyle::Liquid,
                };
                let (buffers, liquid) = (mesh.buffers(), appearance::liquid(scene));
                frame.surface = Some(DrawnSurface::new(buffers, liquid).with_style(style));
                frame.droplets = drawn.droplets().map(|buffers| appearance::droplets(scene, buffers, liquid));
            }
            (DisplayMode::Slice, _) => {
                let (axis, low, high) = match look.slice_axis {
                    Axis::X => (Axis::X, scene.domain.min.x, scene.domain.max.x),
                    Axis::Y => (Axis::Y, scene.domain.min.y, scene.domain.max.y),
                    Axis::Z => (Axis::Z, scene.domain.min.z, scene.domain.max.z),
                };
                let position = low + look.slice_at * (high - low);
                frame.slice = Some(DrawnSlice::new(drawn.particles(), axis, position, radius, colouring));
            }
            // The screen-space liquid is drawn until the first surface is extracted.
            (DisplayMode::Smooth | DisplayMode::Surface | DisplayMode::Triangles, _) => {
                let (buffers, liquid) = (drawn.particles(), appearance::liquid(scene));
                frame.liquid_particles = Some(DrawnLiquidParticles::new(buffers, radius, liquid));
            }
        }
        let mut encoder = self
            .gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("picture") });
        self.renderer.draw(&mut encoder, &target.view, size, &frame)?;
        self.gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// Enables or disables timing; returns the times per pass of a recent picture.
    pub fn time_passes(&mut self, wanted: bool) -> &[PassTime] {
        if self.timing != wanted {
            self.timing = wanted;
            self.renderer.set_timing(wanted);
        }
        if wanted { self.renderer.pass_times() } else { &[] }
    }

    /// The texture drawn last.
    pub fn view(&self) -> Option<&wgpu::TextureView> {
        self.target.as_ref().map(|target| &target.view)
    }

    /// The texture drawn last and its size in pixels, for reading.
    pub fn texture_drawn(&self) -> Option<(wgpu::Texture, [u32; 2])> {
        self.target.as_ref().map(|target| (target.texture.clone(), target.size))
    }

    /// The picture drawn last as 8-bit RGBA rows from the top; `None` before the first, or if the device was lost.
    /// Waits for the device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn read(&self) -> Option<Vec<u8>> {
        let (texture, size) = self.texture_drawn()?;
        splashdown_gpu::block_on(pixels::read(Arc::clone(&self.gpu), texture, size))
    }

    /// Uploads the bodies if the scene has changed or a body has moved.
    fn place_bodies(&mut self, snapshot: &Snapshot) -> Result<(), RenderError> {
        let opened = &snapshot.opened;
        if self.scene_bodies.as_ref().is_none_or(|scene| !Arc::ptr_eq(&scene.meshes, &opened.bodies)) {
            let bodies = opened.bodies.iter().map(|body| {
                let colour = body.colour.unwrap_or(PlacedBody::COLOUR);
                PlacedBody::new(&body.mesh.vertices, &body.mesh.triangles, colour)
            });
            let bodies = bodies.collect::<Result<_, _>>()?;
            self.scene_bodies = Some(SceneBodies { meshes: Arc::clone(&opened.bodies), bodies });
            self.placed = None;
        }
        let Some(scene) =
            self.scene_bodies.as_ref().filter(|scene| scene.bodies.len() == snapshot.bodies.len())
        else {
            self.placed = None;
            return Ok(());
        };
        let is_unchanged = |placed: &PlacedBodies| {
            let mut both = placed.states.iter().zip(&snapshot.bodies);
            both.all(|(a, b)| a.position == b.position && a.orientation == b.orientation)
        };
        if scene.bodies.is_empty() || self.placed.as_ref().is_some_and(is_unchanged) {
            return Ok(());
        }
        let bodies = scene.bodies.iter().zip(&snapshot.bodies);
        let placed =
            bodies.map(|(body, state)| (body, state.position.to_array(), state.orientation.to_array()));
        self.placed = Some(PlacedBodies {
            states: snapshot.bodies.clone(),
            uploaded: UploadedBodies::new(&self.gpu.device, placed),
        });
        Ok(())
    }

    fn texture(&self, [width, height]: [u32; 2]) -> Target {
        let texture = self.gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("picture"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                | wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Target { texture, view, size: [width, height] }
    }
}
