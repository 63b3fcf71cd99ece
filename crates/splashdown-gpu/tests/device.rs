//! Adapters: selection, rejected names, and a machine without drivers.

use std::process::Command;
use std::sync::Arc;

use splashdown_gpu::scan::Scan;
use splashdown_gpu::{
    DeviceRequest, Executor, Gpu, GpuError, GpuExecutor, Recording, list_adapters, testing,
};

#[test]
fn listed_adapters_can_be_opened_by_name() {
    if testing::gpu_or_skip("listed_adapters_can_be_opened_by_name").is_none() {
        return;
    }
    let adapters = list_adapters();
    let adapter = adapters.first().expect("a device was opened");
    assert!(adapters.is_sorted_by_key(|adapter| adapter.software), "software drivers come last");
    assert!(adapter.largest_buffer() >= 128 << 20, "{adapter:?}");
    assert!(adapter.limits.max_storage_buffers_per_shader_stage >= 8);
    let gpu = Gpu::open(&DeviceRequest::Named(adapter.info.name.to_uppercase())).unwrap();
    assert_eq!(gpu.info.name, adapter.info.name);
    assert_eq!(gpu.is_software(), adapter.software);
    assert_eq!(gpu.largest_buffer(), adapter.largest_buffer());
    assert!(gpu.name().contains(&adapter.info.name));
    gpu.health("nothing").unwrap();
}

#[test]
fn an_unknown_name_is_rejected_with_the_available_names() {
    for name in ["Voodoo 2", ""] {
        let error = Gpu::open(&DeviceRequest::Named(name.into())).unwrap_err();
        assert!(matches!(error, GpuError::UnknownDevice { .. }), "{error}");
        let message = error.to_string();
        assert!(message.contains(&format!("{name:?}")), "{message}");
        match list_adapters().first() {
            Some(adapter) => assert!(message.contains(&adapter.info.name), "{message}"),
            None => assert!(message.contains("only the CPU"), "{message}"),
        }
    }
}

#[test]
fn an_unavailable_kind_is_rejected_with_the_available_names() {
    let adapters = list_adapters();
    for (request, software) in [(DeviceRequest::Hardware, false), (DeviceRequest::Software, true)] {
        let there = adapters.iter().any(|adapter| adapter.software == software);
        match Gpu::open(&request) {
            Ok(gpu) => assert!(there && gpu.is_software() == software, "{request:?} opened {}", gpu.name()),
            Err(GpuError::NoAdapter { .. }) => assert!(adapters.is_empty()),
            Err(GpuError::NoneOfKind { available, .. }) => {
                assert!(!there && available.contains(&adapters[0].info.name), "{request:?}: {available}");
            }
            Err(error) => panic!("{request:?}: {error}"),
        }
    }
}

#[test]
fn shaders_without_checks_have_the_same_results() {
    if testing::gpu_or_skip("shaders_without_checks_have_the_same_results").is_none() {
        return;
    }
    let flags: Vec<u32> = (0..50_000).map(|i| testing::noise(i) & 1).collect();
    let scanned = |gpu: Gpu| {
        let mut executor = Executor::from(GpuExecutor::new(Arc::new(gpu)));
        let (counts, starts) =
            (executor.create_from("counts", &flags).unwrap(), executor.create("starts", 50_001).unwrap());
        let mut recording = Recording::new("scan");
        Scan::new(&mut executor, 50_000).unwrap().record(&mut recording, counts, starts);
        executor.run(&recording).unwrap();
        executor.read(starts).unwrap()
    };
    let open = || Gpu::open(&DeviceRequest::Auto).unwrap();
    // SAFETY: the scan stays inside its buffers for any contents.
    let (checked, unchecked) = (open(), unsafe { open().without_shader_checks() });
    assert!(checked.checks_shaders() && !unchecked.checks_shaders());
    let starts = scanned(checked);
    assert_eq!(starts.last(), Some(&flags.iter().sum()));
    assert!(scanned(unchecked) == starts);
}

/// Set in the child process that runs without drivers.
const CHILD: &str = "SPLASHDOWN_TEST_WITHOUT_DRIVERS";

#[test]
fn opening_without_a_driver_fails_with_installation_advice() {
    if std::env::var_os(CHILD).is_some() {
        assert!(list_adapters().is_empty());
        for request in [DeviceRequest::Auto, DeviceRequest::Hardware, DeviceRequest::Software] {
            let error = Gpu::open(&request).unwrap_err();
            assert!(matches!(error, GpuError::NoAdapter { .. }), "{error}");
            assert!(error.to_string().contains("mesa-vulkan-drivers"), "{error}");
        }
        return;
    }
    if cfg!(not(target_os = "linux")) {
        return; // on other systems no environment variable hides the drivers
    }
    let test = std::env::current_exe().unwrap();
    let output = Command::new(test)
        .args(["--exact", "opening_without_a_driver_fails_with_installation_advice", "--nocapture"])
        .env(CHILD, "1")
        .env("VK_ICD_FILENAMES", "/nonexistent")
        .env("VK_DRIVER_FILES", "/nonexistent")
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && text.contains("1 passed"), "{text}");
}
