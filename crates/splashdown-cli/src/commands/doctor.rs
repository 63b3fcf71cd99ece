//! `splashdown doctor`: the devices of this machine, their limits, and missing software.

use std::process::{Command, Stdio};

use serde::Serialize;
use splashdown::memory_forecast;
use splashdown::sample::MAX_PARTICLES;
use splashdown::scene::{Derived, Scene, presets};
use splashdown_gpu::{AdapterReport, MISSING_DRIVER_HINT, list_adapters};

use crate::args::DoctorArguments;
use crate::{console, human, memory};

/// The JSON output.
#[derive(Debug, Serialize)]
struct Health {
    version: &'static str,
    cpu: Cpu,
    adapters: Vec<Adapter>,
    ffmpeg: Option<String>,
    simulates_on: String,
    draws_on: Option<String>,
    advice: Vec<String>,
}

#[derive(Debug, Serialize)]
struct Cpu {
    threads: usize,
    features: Vec<&'static str>,
    memory: Option<u64>,
    memory_available: Option<u64>,
    largest_particle_count: Option<u64>,
}

#[derive(Debug, Serialize)]
struct Adapter {
    name: String,
    backend: String,
    kind: &'static str,
    driver: String,
    largest_buffer: u64,
    largest_particle_count: u64,
    largest_workgroup: u32,
    workgroups_per_dimension: u32,
    storage_buffers_per_stage: u32,
    workgroup_memory: u32,
    timestamps: bool,
}

/// Examines the machine and prints the result.
pub fn run(arguments: &DoctorArguments) {
    let health = examine();
    if arguments.json {
        console::print_json(&health);
    } else {
        console::print(describe(&health));
    }
}

fn examine() -> Health {
    let reports = list_adapters();
    let adapters: Vec<Adapter> = reports.iter().map(adapter).collect();
    let ffmpeg = ffmpeg_version();
    let hardware = reports.iter().position(|report| !report.software);
    let mut advice = Vec::new();
    if adapters.is_empty() {
        advice.push(format!("no Vulkan, Metal or Direct3D 12 driver was found, so no pictures can be drawn: {MISSING_DRIVER_HINT}"));
    } else if hardware.is_none() {
        advice.push("only a software driver was found. Pictures are drawn with it; the simulation runs on the CPU, which is faster. If this machine has a graphics card, install its driver".to_owned());
    }
    if ffmpeg.is_none() {
        advice.push("ffmpeg was not found, so no films can be made of the pictures. Install it: on Debian and Ubuntu `apt-get install ffmpeg`, on macOS `brew install ffmpeg`, on Windows `winget install ffmpeg`".to_owned());
    }
    let name = |adapter: &Adapter| format!("{} ({})", adapter.name, adapter.backend);
    let chosen = hardware.and_then(|index| adapters.get(index));
    Health {
        version: env!("CARGO_PKG_VERSION"),
        cpu: cpu(),
        simulates_on: chosen.map_or_else(|| "the CPU".to_owned(), name),
        draws_on: adapters.first().map(name),
        adapters,
        ffmpeg,
        advice,
    }
}

fn adapter(report: &AdapterReport) -> Adapter {
    use wgpu::DeviceType;
    let limits = &report.limits;
    Adapter {
        name: report.info.name.clone(),
        backend: format!("{:?}", report.info.backend),
        kind: match report.info.device_type {
            DeviceType::DiscreteGpu => "discrete GPU",
            DeviceType::IntegratedGpu => "integrated GPU",
            DeviceType::VirtualGpu => "virtual GPU",
            DeviceType::Cpu => "software driver",
            DeviceType::Other => "other",
        },
        driver: format!("{} {}", report.info.driver, report.info.driver_info).trim().to_owned(),
        largest_buffer: report.largest_buffer(),
        largest_particle_count: splashdown::largest_particle_count(report.largest_buffer())
            .min(MAX_PARTICLES),
        largest_workgroup: limits.max_compute_invocations_per_workgroup,
        workgroups_per_dimension: limits.max_compute_workgroups_per_dimension,
        storage_buffers_per_stage: limits.max_storage_buffers_per_shader_stage,
        workgroup_memory: limits.max_compute_workgroup_storage_size,
        timestamps: report.timestamps,
    }
}

fn cpu() -> Cpu {
    let memory_available = memory::available();
    Cpu {
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        features: features(),
        memory: memory::total(),
        memory_available,
        largest_particle_count: memory_available
            .zip(bytes_per_particle())
            .map(|(bytes, each)| (bytes / each).min(MAX_PARTICLES)),
    }
}

/// Bytes per particle of the demo scene in all buffers together, including its share of cells and surface. On the CPU
/// the total memory is the limit, not a single buffer.
fn bytes_per_particle() -> Option<u64> {
    let (name, text) = presets().first()?;
    let scene = Scene::parse(text, name).ok()?;
    memory_forecast(&scene).checked_div(Derived::new(&scene).particles)
}

#[cfg(any(target_arch = "x86_64", target_arch = "x86"))]
fn features() -> Vec<&'static str> {
    let all = [
        ("sse4.1", is_x86_feature_detected!("sse4.1")),
        ("avx2", is_x86_feature_detected!("avx2")),
        ("fma", is_x86_feature_detected!("fma")),
        ("avx512f", is_x86_feature_detected!("avx512f")),
    ];
    all.into_iter().filter_map(|(name, found)| found.then_some(name)).collect()
}

#[cfg(target_arch = "aarch64")]
fn features() -> Vec<&'static str> {
    vec!["neon"]
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "x86", target_arch = "aarch64")))]
fn features() -> Vec<&'static str> {
    Vec::new()
}

fn ffmpeg_version() -> Option<String> {
    let output = Command::new("ffmpeg").arg("-version").stdin(Stdio::null()).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let version = text.strip_prefix("ffmpeg version ")?.split_whitespace().next()?.to_owned();
    output.status.success().then_some(version)
}

fn describe(health: &Health) -> String {
    let mut text = format!("Splashdown {}\n\nCPU\n", health.version);
    let cpu = &health.cpu;
    let mut rows = vec![("threads", cpu.threads.to_string()), ("features", cpu.features.join(", "))];
    if let (Some(total), Some(available)) = (cpu.memory, cpu.memory_available) {
        rows.push((
            "memory",
            format!("{}, {} of it available", human::bytes(total), human::bytes(available)),
        ));
    }
    if let Some(count) = cpu.largest_particle_count {
        rows.push(("capacity", format!("about {} particles", human::count(count))));
    }
    text += &console::table(&rows);
    if health.adapters.is_empty() {
        text += "\n\nNo graphics adapter.";
    }
    for adapter in &health.adapters {
        let rows = [
            ("kind", adapter.kind.to_owned()),
            ("driver", adapter.driver.clone()),
            ("largest buffer", human::bytes(adapter.largest_buffer)),
            ("capacity", format!("at most {} particles", human::count(adapter.largest_particle_count))),
            (
                "workgroup",
                format!(
                    "{} invocations, {} shared",
                    adapter.largest_workgroup,
                    human::bytes(adapter.workgroup_memory.into())
                ),
            ),
            (
                "dispatch",
                format!("{} workgroups per dimension", human::count(adapter.workgroups_per_dimension.into())),
            ),
            ("storage buffers", format!("{} per stage", adapter.storage_buffers_per_stage)),
            ("timing of passes", if adapter.timestamps { "yes" } else { "no" }.to_owned()),
        ];
        text += &format!("\n\n{} ({})\n{}", adapter.name, adapter.backend, console::table(&rows));
    }
    let rows = [
        ("to simulate", health.simulates_on.clone()),
        ("to draw", health.draws_on.clone().unwrap_or_else(|| "nothing: no driver".to_owned())),
        (
            "to make films",
            health
                .ffmpeg
                .as_ref()
                .map_or_else(|| "nothing: no ffmpeg".to_owned(), |version| format!("ffmpeg {version}")),
        ),
    ];
    text += &format!("\n\nWith --device auto, this machine uses\n{}", console::table(&rows));
    for advice in &health.advice {
        text += &format!("\n\nNote: {advice}.");
    }
    text
}
