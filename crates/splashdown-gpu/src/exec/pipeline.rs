//! Creates the pipeline of a pass from its declaration.

use std::collections::HashMap;

use crate::{Access, BufferId, Gpu, GpuError, PassDesc};

/// A compiled pass, and the bind groups of the buffers that it has used.
pub(super) struct Pipeline {
    pub pipeline: wgpu::ComputePipeline,
    pub layout: wgpu::BindGroupLayout,
    pub bind_groups: HashMap<Vec<BufferId>, wgpu::BindGroup>,
}

impl Pipeline {
    /// Compiles a pass.
    pub fn build(gpu: &Gpu, pass: &'static PassDesc) -> Result<Self, GpuError> {
        let source = pass.source().map_err(|reason| GpuError::BadShader { pass: pass.label, reason })?;
        let ((pipeline, layout), error) =
            gpu.scoped(wgpu::ErrorFilter::Validation, |_| Self::compile(gpu, pass, &source));
        if let Some(error) = error {
            return Err(GpuError::BadShader { pass: pass.label, reason: error.to_string() });
        }
        Ok(Self { pipeline, layout, bind_groups: HashMap::new() })
    }

    /// Compiles a pass to check whether the device accepts it.
    pub async fn try_out(gpu: &Gpu, pass: &'static PassDesc) -> Result<(), GpuError> {
        let source = pass.source().map_err(|reason| GpuError::BadShader { pass: pass.label, reason })?;
        let scope = gpu.device.push_error_scope(wgpu::ErrorFilter::Validation);
        Self::compile(gpu, pass, &source);
        match scope.pop().await {
            Some(error) => Err(GpuError::BadShader { pass: pass.label, reason: error.to_string() }),
            None => Ok(()),
        }
    }

    fn compile(
        gpu: &Gpu,
        pass: &'static PassDesc,
        source: &str,
    ) -> (wgpu::ComputePipeline, wgpu::BindGroupLayout) {
        let device = &gpu.device;
        let descriptor = wgpu::ShaderModuleDescriptor {
            label: Some(pass.label),
            source: wgpu::ShaderSource::Wgsl(source.into()),
        };
        let module = if gpu.checks_shaders() {
            device.create_shader_module(descriptor)
        } else {
            // SAFETY: the caller of `without_shader_checks` guarantees that its passes stay inside their buffers and
            // end.
            unsafe { device.create_shader_module_trusted(descriptor, wgpu::ShaderRuntimeChecks::unchecked()) }
        };
        let entries: Vec<_> = pass
            .bindings
            .iter()
            .enumerate()
            .map(|(i, binding)| wgpu::BindGroupLayoutEntry {
                binding: i as u32,
                visibility: wgpu::ShaderStages::COMPUTE,
                ty: wgpu::BindingType::Buffer {
                    ty: match binding.access {
                        Access::Uniform => wgpu::BufferBindingType::Uniform,
                        Access::Read => wgpu::BufferBindingType::Storage { read_only: true },
                        Access::ReadWrite => wgpu::BufferBindingType::Storage { read_only: false },
                    },
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            })
            .collect();
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(pass.label),
            entries: &entries,
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(pass.label),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(pass.label),
            layout: Some(&pipeline_layout),
            module: &module,
            entry_point: Some(pass.entry),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: pass.constants,
                // Every pass writes its workgroup memory before it reads it; the tests run with poisoned buffers.
                zero_initialize_workgroup_memory: false,
            },
            cache: None,
        });
        (pipeline, layout)
    }
}
