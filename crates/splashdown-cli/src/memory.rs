//! The memory of this machine, where the system reports it in a file (Linux), and a check whether a scene fits.

use splashdown::scene::{Derived, Scene};
use splashdown::{Device, memory_forecast, neighbour_search_forecast};
use splashdown_gpu::list_adapters;
use splashdown_run::picture_memory;

use crate::exit::{Exit, Failure};
use crate::human;

/// Refuses a scene that does not fit into memory if the CPU simulates. The library checks the limits of GPUs.
///
/// # Errors
/// [`Exit::Device`], with the required and the available memory.
pub fn check(scene: &Scene, device: &Device) -> Result<(), Failure> {
    let search = neighbour_search_forecast(scene, Derived::new(scene).particles, None);
    let needed = memory_forecast(scene).saturating_add(search);
    let Some(available) = available().filter(|&available| needed > available) else { return Ok(()) };
    let on_cpu = match device {
        Device::Cpu => true,
        Device::Auto => list_adapters().iter().all(|adapter| adapter.software),
        Device::Gpu | Device::Named(_) => false,
    };
    if !on_cpu {
        return Ok(());
    }
    let message = format!(
        "the scene needs about {} of memory and {} are available: choose a larger fluid.particle_spacing, or close other programs",
        human::bytes(needed),
        human::bytes(available)
    );
    Err(Failure::new(Exit::Device, message))
}

/// Refuses pictures that do not fit into memory. Devices with their own memory report that they have too little when a
/// picture is drawn.
///
/// # Errors
/// [`Exit::Device`], with the required and the available memory.
pub fn check_picture(size: [u32; 2]) -> Result<(), Failure> {
    let forecast = picture_memory(size);
    let Some(available) = available() else { return Ok(()) };
    let draws_on_cpu = || list_adapters().iter().all(|adapter| adapter.software);
    // Listing adapters takes a moment.
    let needed = match forecast.host + forecast.device > available && draws_on_cpu() {
        true => forecast.host + forecast.device,
        false => forecast.host,
    };
    if needed <= available {
        return Ok(());
    }
    let message = format!(
        "pictures of {} x {} pixels need about {} of memory and {} are available: draw smaller pictures, or close other programs",
        size[0],
        size[1],
        human::bytes(needed),
        human::bytes(available)
    );
    Err(Failure::new(Exit::Device, message))
}

/// Total memory in bytes.
pub fn total() -> Option<u64> {
    value("MemTotal:")
}

/// Available memory in bytes.
pub fn available() -> Option<u64> {
    value("MemAvailable:")
}

/// Resident bytes of this process.
pub fn resident() -> Option<u64> {
    parse(&std::fs::read_to_string("/proc/self/status").ok()?, "VmRSS:")
}

/// Peak resident bytes of this process so far.
pub fn peak() -> Option<u64> {
    parse(&std::fs::read_to_string("/proc/self/status").ok()?, "VmHWM:")
}

fn value(name: &str) -> Option<u64> {
    parse(&std::fs::read_to_string("/proc/meminfo").ok()?, name)
}

fn parse(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kib.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn lines_of_meminfo_are_read() {
        let text = "MemTotal:       24626928 kB\nMemFree:          8 kB\nMemAvailable:   23000000 kB\n";
        assert_eq!(parse(text, "MemAvailable:"), Some(23_000_000 * 1024));
        assert_eq!(parse(text, "SwapTotal:"), None);
        assert_eq!(parse("MemTotal: lots kB", "MemTotal:"), None);
        assert_eq!(parse("VmPeak:\t 9 kB\nVmHWM:\t    7040 kB\n", "VmHWM:"), Some(7040 * 1024));
    }
}
