//! Construction of render pipelines and bind groups. Each pass specifies only the settings that
//! differ from the defaults.

use crate::shader::Shader;
use wgpu::{
    BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType, BlendState,
    BufferBindingType, ColorWrites, CompareFunction, Device, Face, PrimitiveTopology, RenderPipeline,
    SamplerBindingType, ShaderStages, TextureFormat, TextureSampleType, TextureViewDimension,
    VertexAttribute, VertexBufferLayout, VertexFormat, VertexStepMode,
};

/// Format of the depth buffer.
pub(crate) const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// Description of a pipeline. Defaults: triangles, no culling, no depth, no blending, one sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PipelineDesc<'a> {
    pub shader: Shader,
    pub layouts: &'a [&'a BindGroupLayout],
    /// Absent if only depths are written.
    pub format: Option<TextureFormat>,
    pub samples: u32,
    pub topology: PrimitiveTopology,
    pub cull: Option<Face>,
    pub depth: Option<Depth>,
    pub blend: Option<BlendState>,
    /// Channels that are written.
    pub write: ColorWrites,
    /// Number of `vec4<f32>` vertex buffers.
    pub vertex_buffers: usize,
    pub constants: &'a [(&'a str, f64)],
}

/// Use of the depth buffer. Depth is reversed: nearer is greater.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Depth {
    Write,
    TestAndWrite,
    Test,
    /// Neither tests nor writes, in a pass with a depth buffer.
    Ignore,
}

impl<'a> PipelineDesc<'a> {
    pub fn new(
        shader: Shader,
        layouts: &'a [&'a BindGroupLayout],
        format: impl Into<Option<TextureFormat>>,
    ) -> PipelineDesc<'a> {
        PipelineDesc {
            shader,
            layouts,
            format: format.into(),
            samples: 1,
            topology: PrimitiveTopology::TriangleList,
            cull: None,
            depth: None,
            blend: None,
            write: ColorWrites::ALL,
            vertex_buffers: 0,
            constants: &[],
        }
    }

    pub fn build(&self, device: &Device) -> RenderPipeline {
        let label = Some(self.shader.label);
        let layouts: Vec<Option<&BindGroupLayout>> = self.layouts.iter().copied().map(Some).collect();
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label,
            bind_group_layouts: &layouts,
            ..Default::default()
        });
        let module = self.shader.module(device);
        let attributes: Vec<VertexAttribute> = (0..self.vertex_buffers)
            .map(|slot| VertexAttribute {
                format: VertexFormat::Float32x4,
                offset: 0,
                shader_location: slot as u32,
            })
            .collect();
        let buffers: Vec<Option<VertexBufferLayout<'_>>> = attributes
            .iter()
            .map(|attribute| {
                let attributes = std::slice::from_ref(attribute);
                Some(VertexBufferLayout { array_stride: 16, step_mode: VertexStepMode::Vertex, attributes })
            })
            .collect();
        let target = self.format.map(|format| wgpu::ColorTargetState {
            format,
            blend: self.blend,
            write_mask: self.write,
        });
        let compilation_options =
            wgpu::PipelineCompilationOptions { constants: self.constants, ..Default::default() };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label,
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex_main"),
                compilation_options: compilation_options.clone(),
                buffers: &buffers,
            },
            primitive: wgpu::PrimitiveState {
                topology: self.topology,
                cull_mode: self.cull,
                ..Default::default()
            },
            depth_stencil: self.depth.map(|depth| wgpu::DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(matches!(depth, Depth::Write | Depth::TestAndWrite)),
                depth_compare: Some(match depth {
                    Depth::Write | Depth::Ignore => CompareFunction::Always,
                    Depth::TestAndWrite | Depth::Test => CompareFunction::GreaterEqual,
                }),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState { count: self.samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment_main"),
                compilation_options,
                targets: target.map(Some).as_slice(),
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// Additive blending.
pub(crate) const ADD: BlendState = {
    let component = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    BlendState { color: component, alpha: component }
};

/// Alpha blending of colours that are already multiplied by alpha.
pub(crate) const PREMULTIPLIED: BlendState = BlendState::PREMULTIPLIED_ALPHA_BLENDING;

/// As [`PREMULTIPLIED`], over an opaque picture, whose alpha becomes the fraction of it that remains visible.
pub(crate) const DIMMING: BlendState = BlendState {
    color: BlendState::PREMULTIPLIED_ALPHA_BLENDING.color,
    alpha: wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::Zero,
        dst_factor: wgpu::BlendFactor::OneMinusSrcAlpha,
        operation: wgpu::BlendOperation::Add,
    },
};

/// Alpha blending (straight alpha) over an opaque picture, which stays opaque.
pub(crate) const OVER: BlendState = BlendState {
    color: wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::SrcAlpha,
        dst_factor: wgpu::BlendFactor::OneMinusSrcAlpha,
        operation: wgpu::BlendOperation::Add,
    },
    alpha: wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::OneMinusSrcAlpha,
        operation: wgpu::BlendOperation::Add,
    },
};

/// The kind of a binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bind {
    Uniform,
    Storage,
    /// A storage buffer that the fragment shader reads.
    FragmentStorage,
    /// A texture loaded by the vertex shader without a sampler.
    VertexTexture,
    Texture,
    /// A texture with several layers.
    TextureLayers,
    /// A texture of any float format, loaded without a sampler.
    Texels,
    /// A texture of integers with 1 or several samples per pixel.
    Integers {
        multisampled: bool,
    },
    /// A depth buffer with 1 or several samples per pixel.
    Depths {
        multisampled: bool,
    },
    Sampler,
}

/// A layout with bindings numbered from 0.
pub(crate) fn bind_group_layout(device: &Device, label: &str, bindings: &[Bind]) -> BindGroupLayout {
    let entries: Vec<BindGroupLayoutEntry> = (0..)
        .zip(bindings)
        .map(|(binding, bind)| BindGroupLayoutEntry {
            binding,
            visibility: match bind {
                Bind::Uniform => ShaderStages::VERTEX_FRAGMENT,
                Bind::Storage | Bind::VertexTexture => ShaderStages::VERTEX,
                Bind::FragmentStorage
                | Bind::Texture
                | Bind::TextureLayers
                | Bind::Texels
                | Bind::Integers { .. }
                | Bind::Depths { .. }
                | Bind::Sampler => ShaderStages::FRAGMENT,
            },
            ty: match bind {
                Bind::Uniform => buffer(BufferBindingType::Uniform),
                Bind::Storage | Bind::FragmentStorage => {
                    buffer(BufferBindingType::Storage { read_only: true })
                }
                Bind::Texture => texture(TextureSampleType::Float { filterable: true }, false),
                Bind::TextureLayers => BindingType::Texture {
                    sample_type: TextureSampleType::Float { filterable: true },
                    view_dimension: TextureViewDimension::D2Array,
                    multisampled: false,
                },
                Bind::VertexTexture | Bind::Texels => {
                    texture(TextureSampleType::Float { filterable: false }, false)
                }
                Bind::Integers { multisampled } => texture(TextureSampleType::Uint, *multisampled),
                Bind::Depths { multisampled } => texture(TextureSampleType::Depth, *multisampled),
                Bind::Sampler => BindingType::Sampler(SamplerBindingType::Filtering),
            },
            count: None,
        })
        .collect();
    device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
}

fn texture(sample_type: TextureSampleType, multisampled: bool) -> BindingType {
    BindingType::Texture { sample_type, view_dimension: TextureViewDimension::D2, multisampled }
}

fn buffer(ty: BufferBindingType) -> BindingType {
    BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None }
}

/// A bind group with entries numbered from 0.
pub(crate) fn bind_group(
    device: &Device,
    label: &str,
    layout: &BindGroupLayout,
    resources: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    let entries: Vec<wgpu::BindGroupEntry<'_>> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
}

/// A bilinear sampler, clamped at the border.
pub(crate) fn linear_sampler(device: &Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("linear"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    })
}
