//! Compiles SPIR-V with a Vulkan driver and reads what its compiler reports. Nothing is executed.

use std::ffi::{CStr, CString};

use anyhow::{Context, Result, ensure};
use ash::{khr, vk};
use splashdown_gpu::{Access, PassDesc};

/// What the compiler reports about a pass: numbers by their names in the driver, and the assembly.
pub struct Report {
    /// The names and values of the statistics.
    pub statistics: Vec<(String, u64)>,
    /// The machine code as text.
    pub assembly: String,
}

/// A device of the driver.
pub struct Driver {
    _entry: ash::Entry,
    instance: ash::Instance,
    device: ash::Device,
    executables: khr::pipeline_executable_properties::Device,
    /// Its name.
    pub name: String,
}

impl Driver {
    /// Opens the first device of the Vulkan loader.
    pub fn open() -> Result<Self> {
        // SAFETY: the loader is the system's Vulkan library.
        let entry = unsafe { ash::Entry::load() }.context("there is no Vulkan loader (libvulkan)")?;
        let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_1);
        let create = vk::InstanceCreateInfo::default().application_info(&application);
        // SAFETY: `create` and what it points to live until the call returns. The same holds for every call below, and
        // all handles come from the device that receives them.
        let instance = unsafe { entry.create_instance(&create, None) }.context("no Vulkan instance")?;
        // SAFETY: see above.
        let physical = unsafe { instance.enumerate_physical_devices() }?;
        let physical = *physical.first().context("the driver has no device")?;
        // SAFETY: see above.
        let properties = unsafe { instance.get_physical_device_properties(physical) };
        let name = properties.device_name_as_c_str()?.to_string_lossy().into_owned();
        let queue = vk::DeviceQueueCreateInfo::default().queue_family_index(0).queue_priorities(&[1.0]);
        let extensions = [khr::pipeline_executable_properties::NAME.as_ptr()];
        let mut wanted = vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default()
            .pipeline_executable_info(true);
        let create = vk::DeviceCreateInfo::default()
            .queue_create_infos(std::slice::from_ref(&queue))
            .enabled_extension_names(&extensions)
            .push_next(&mut wanted);
        // SAFETY: see above.
        let device = unsafe { instance.create_device(physical, &create, None) }
            .context("the driver creates no device that describes its programs")?;
        let executables = khr::pipeline_executable_properties::Device::new(&instance, &device);
        Ok(Self { _entry: entry, instance, device, executables, name })
    }

    /// Compiles a pass.
    pub fn compile(&self, pass: &PassDesc, spirv: &[u32]) -> Result<Report> {
        let device = &self.device;
        let bindings: Vec<_> = pass.bindings.iter().zip(0..).map(binding).collect();
        let layout = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: see `open`.
        let set = unsafe { device.create_descriptor_set_layout(&layout, None) }?;
        let layout = vk::PipelineLayoutCreateInfo::default().set_layouts(std::slice::from_ref(&set));
        // SAFETY: see `open`.
        let layout = unsafe { device.create_pipeline_layout(&layout, None) }?;
        let module = vk::ShaderModuleCreateInfo::default().code(spirv);
        // SAFETY: see `open`.
        let module = unsafe { device.create_shader_module(&module, None) }?;
        let entry = CString::new(pass.entry)?;
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module)
            .name(&entry);
        let flags = vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR
            | vk::PipelineCreateFlags::CAPTURE_INTERNAL_REPRESENTATIONS_KHR;
        let create = vk::ComputePipelineCreateInfo::default().flags(flags).stage(stage).layout(layout);
        // SAFETY: see `open`.
        let pipelines = unsafe {
            device.create_compute_pipelines(vk::PipelineCache::null(), std::slice::from_ref(&create), None)
        };
        let pipeline = pipelines.map_err(|(_, error)| error).with_context(|| pass.label)?[0];
        let report = self.report(pipeline).with_context(|| pass.label);
        // SAFETY: nothing uses these handles any more.
        unsafe {
            device.destroy_pipeline(pipeline, None);
            device.destroy_shader_module(module, None);
            device.destroy_pipeline_layout(layout, None);
            device.destroy_descriptor_set_layout(set, None);
        }
        report
    }

    fn report(&self, pipeline: vk::Pipeline) -> Result<Report> {
        let info = vk::PipelineExecutableInfoKHR::default().pipeline(pipeline).executable_index(0);
        // SAFETY: see `open`.
        let statistics = unsafe { self.executables.get_pipeline_executable_statistics(&info) }?;
        let statistics = statistics.iter().map(|one| {
            // SAFETY: the format says which member of the union is set; all have eight bytes.
            let value = unsafe { one.value.u64 };
            (text(&one.name), value)
        });
        let statistics = statistics.collect();
        // SAFETY: see `open`. Without memory for the texts the call reports their sizes.
        let mut texts = unsafe { self.executables.get_pipeline_executable_internal_representations(&info) }?;
        let mut memory: Vec<Vec<u8>> = texts.iter().map(|one| vec![0; one.data_size]).collect();
        for (one, bytes) in texts.iter_mut().zip(&mut memory) {
            one.p_data = bytes.as_mut_ptr().cast();
        }
        let mut count = u32::try_from(texts.len())?;
        // SAFETY: every text has the memory that the driver asked for.
        let result = unsafe {
            (self.executables.fp().get_pipeline_executable_internal_representations_khr)(
                self.device.handle(),
                &raw const info,
                &raw mut count,
                texts.as_mut_ptr(),
            )
        };
        ensure!(result == vk::Result::SUCCESS, "the driver does not show its program ({result})");
        let is_assembly = |name: &str| name.to_lowercase().contains("assembly");
        let assembly = texts.iter().zip(&memory).find(|(one, _)| is_assembly(&text(&one.name)));
        let assembly = assembly.map(|(_, bytes)| String::from_utf8_lossy(bytes).into_owned());
        Ok(Report { statistics, assembly: assembly.unwrap_or_default() })
    }
}

impl Drop for Driver {
    fn drop(&mut self) {
        // SAFETY: the pipelines are destroyed, and nothing was submitted.
        unsafe {
            self.device.destroy_device(None);
            self.instance.destroy_instance(None);
        }
    }
}

fn binding((binding, number): (&splashdown_gpu::Binding, u32)) -> vk::DescriptorSetLayoutBinding<'static> {
    let kind = match binding.access {
        Access::Uniform => vk::DescriptorType::UNIFORM_BUFFER,
        Access::Read | Access::ReadWrite => vk::DescriptorType::STORAGE_BUFFER,
    };
    vk::DescriptorSetLayoutBinding::default()
        .binding(number)
        .descriptor_type(kind)
        .descriptor_count(1)
        .stage_flags(vk::ShaderStageFlags::COMPUTE)
}

/// The text of an array of characters that ends at a zero.
fn text(characters: &[std::ffi::c_char]) -> String {
    let bytes: Vec<u8> = characters.iter().map(|&c| c as u8).collect();
    CStr::from_bytes_until_nul(&bytes).map_or(String::new(), |text| text.to_string_lossy().into_owned())
}
