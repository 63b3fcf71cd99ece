//! Recording of the render passes of a picture.

use crate::targets::Targets;
use splashdown_gpu::PassTimer;
use wgpu::{
    Color, CommandEncoder, LoadOp, Operations, RenderPass, RenderPassColorAttachment,
    RenderPassDepthStencilAttachment, RenderPassDescriptor, StoreOp, TextureView,
};

/// Records passes into the caller's encoder.
#[derive(Debug)]
pub(crate) struct Recorder<'a> {
    encoder: &'a mut CommandEncoder,
    timer: Option<&'a mut PassTimer>,
}

/// Contents of the samples and depths at the start of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Start {
    Clear,
    Load,
}

/// What happens to the samples and depths at the end of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// The samples are resolved; samples and depths are discarded.
    Resolve,
    /// Samples and depths are stored for a later pass.
    Store,
    /// The samples are resolved; samples and depths are stored.
    ResolveAndStore,
}

impl<'a> Recorder<'a> {
    /// Begins a picture; if there is a timer, it measures the passes.
    pub fn new(encoder: &'a mut CommandEncoder, mut timer: Option<&'a mut PassTimer>) -> Recorder<'a> {
        if let Some(timer) = &mut timer {
            timer.begin();
        }
        Recorder { encoder, timer }
    }

    /// For what is not a pass.
    pub fn encoder(&mut self) -> &mut CommandEncoder {
        self.encoder
    }

    /// Ends the picture.
    pub fn finish(self) {
        if let Some(timer) = self.timer {
            timer.end(self.encoder);
        }
    }

    /// A pass into `result`; with several samples per pixel, into the samples, which may be resolved into it.
    pub fn picture(
        &mut self,
        label: &'static str,
        targets: &Targets,
        result: &TextureView,
        start: Start,
        end: End,
    ) -> RenderPass<'_> {
        let store_samples = if end == End::Resolve { StoreOp::Discard } else { StoreOp::Store };
        let (view, resolve_target, store) = match &targets.samples {
            Some(samples) => (samples, (end != End::Store).then_some(result), store_samples),
            None => (result, None, StoreOp::Store),
        };
        let load = if start == Start::Load { LoadOp::Load } else { LoadOp::Clear(Color::BLACK) };
        let load_depth = if start == Start::Load { LoadOp::Load } else { LoadOp::Clear(0.0) };
        let colour = RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target,
            ops: Operations { load, store },
        };
        self.begin(
            label,
            colour,
            Some((&targets.depth, Operations { load: load_depth, store: store_samples })),
        )
    }

    /// A pass into a texture that is cleared first.
    pub fn cleared(&mut self, label: &'static str, view: &TextureView, clear: Color) -> RenderPass<'_> {
        self.begin(label, colour(view, LoadOp::Clear(clear)), None)
    }

    /// A pass into a texture that is cleared first, with a depth buffer that is discarded
    /// afterwards.
    pub fn cleared_with_depth(
        &mut self,
        label: &'static str,
        view: &TextureView,
        clear: Color,
        depth: &TextureView,
    ) -> RenderPass<'_> {
        let operations = Operations { load: LoadOp::Clear(0.0), store: StoreOp::Discard };
        self.begin(label, colour(view, LoadOp::Clear(clear)), Some((depth, operations)))
    }

    /// A pass into a texture that is filled with zeros first, over the existing depths of a picture.
    pub fn over_depth(
        &mut self,
        label: &'static str,
        view: &TextureView,
        depth: &TextureView,
    ) -> RenderPass<'_> {
        let operations = Operations { load: LoadOp::Load, store: StoreOp::Store };
        self.begin(label, colour(view, LoadOp::Clear(Color::TRANSPARENT)), Some((depth, operations)))
    }

    /// A pass that marks pixels in a depth buffer by zeros among ones.
    pub fn marks(&mut self, label: &'static str, depth: &TextureView) -> RenderPass<'_> {
        let operations = Operations { load: LoadOp::Clear(1.0), store: StoreOp::Store };
        self.begin(label, None, Some((depth, operations)))
    }

    /// A pass that writes depths only.
    pub fn depths(&mut self, label: &'static str, depths: &TextureView) -> RenderPass<'_> {
        let operations = Operations { load: LoadOp::Clear(0.0), store: StoreOp::Store };
        self.begin(label, None, Some((depths, operations)))
    }

    /// A pass over the existing contents of a texture, at marked pixels.
    pub fn over_marks(
        &mut self,
        label: &'static str,
        view: &TextureView,
        depth: &TextureView,
    ) -> RenderPass<'_> {
        let operations = Operations { load: LoadOp::Load, store: StoreOp::Discard };
        self.begin(label, colour(view, LoadOp::Load), Some((depth, operations)))
    }

    /// A pass with one sample per pixel and a depth buffer, both stored.
    pub fn one_sample(
        &mut self,
        label: &'static str,
        view: &TextureView,
        depth: &TextureView,
        start: Start,
    ) -> RenderPass<'_> {
        let (load, load_depth) = match start {
            Start::Clear => (LoadOp::Clear(Color::BLACK), LoadOp::Clear(0.0)),
            Start::Load => (LoadOp::Load, LoadOp::Load),
        };
        let operations = Operations { load: load_depth, store: StoreOp::Store };
        self.begin(label, colour(view, load), Some((depth, operations)))
    }

    /// A pass over the existing contents of a texture.
    pub fn over(&mut self, label: &'static str, view: &TextureView) -> RenderPass<'_> {
        self.begin(label, colour(view, LoadOp::Load), None)
    }

    fn begin<'r>(
        &mut self,
        label: &'static str,
        colour: impl Into<Option<RenderPassColorAttachment<'r>>>,
        depth: Option<(&'r TextureView, Operations<f32>)>,
    ) -> RenderPass<'_> {
        self.encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some(label),
            color_attachments: colour.into().map(Some).as_slice(),
            depth_stencil_attachment: depth.map(|(view, operations)| RenderPassDepthStencilAttachment {
                view,
                depth_ops: Some(operations),
                stencil_ops: None,
            }),
            timestamp_writes: self.timer.as_mut().and_then(|timer| timer.render_pass(label)),
            ..Default::default()
        })
    }
}

fn colour(view: &TextureView, load: LoadOp<Color>) -> RenderPassColorAttachment<'_> {
    RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: Operations { load, store: StoreOp::Store },
    }
}
