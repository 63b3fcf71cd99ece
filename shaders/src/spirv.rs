//! SPIR-V of a pass, as the program compiles it.

use anyhow::{Context, Result, anyhow};
use naga::back::spv;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use splashdown_gpu::PassDesc;

/// The SPIR-V of a pass. `checked`: with the bounds checks of browsers, which the program leaves out on other devices.
pub fn spirv(pass: &PassDesc, checked: bool) -> Result<Vec<u32>> {
    let source = pass.source().map_err(|reason| anyhow!("{}: {reason}", pass.label))?;
    let module = naga::front::wgsl::parse_str(&source)
        .map_err(|error| anyhow!("{}: {}", pass.label, error.emit_to_string(&source)))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module)?;
    let constants = pass.constants.iter().map(|&(name, value)| (name.to_owned(), value)).collect();
    let stage = naga::ShaderStage::Compute;
    let (module, info) = naga::back::pipeline_constants::process_overrides(
        &module,
        &info,
        Some((stage, pass.entry)),
        &constants,
    )?;
    let policy = if checked { BoundsCheckPolicy::Restrict } else { BoundsCheckPolicy::Unchecked };
    let options = spv::Options {
        lang_version: (1, 3),
        flags: spv::WriterFlags::empty(),
        bounds_check_policies: BoundsCheckPolicies {
            index: policy,
            buffer: policy,
            image_load: policy,
            binding_array: BoundsCheckPolicy::Unchecked,
        },
        force_loop_bounding: checked,
        ..spv::Options::default()
    };
    let entry = spv::PipelineOptions { shader_stage: stage, entry_point: pass.entry.to_owned() };
    spv::write_vec(&module, &info, &options, Some(&entry)).with_context(|| pass.label.to_owned())
}
