//! The gate: every pass agrees with its WGSL, every WGSL file belongs to a pass, and every label is unique.

use std::path::Path;

use splashdown_gpu::testing;

const SOURCES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/src");

#[test]
fn every_pass_agrees_with_its_wgsl_and_every_wgsl_file_has_a_pass() {
    let wrong = testing::gate(Path::new(SOURCES), &splashdown::passes());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Negative control: if a pass is missing from the list, its WGSL file belongs to no pass.
#[test]
fn a_missing_pass_is_detected() {
    let passes = splashdown::passes();
    let alone: Vec<_> = passes
        .iter()
        .filter(|pass| passes.iter().filter(|other| other.wgsl == pass.wgsl).count() == 1)
        .collect();
    assert!(alone.len() > 10, "{}", alone.len());
    for left_out in alone {
        let rest: Vec<_> = passes.iter().copied().filter(|pass| pass.label != left_out.label).collect();
        let wrong = testing::gate(Path::new(SOURCES), &rest);
        assert!(wrong.iter().any(|line| line.contains("no pass uses it")), "{}: {wrong:?}", left_out.label);
    }
}

/// Negative control: a missing variant is detected too, although it shares its file with other passes.
#[test]
fn a_missing_variant_is_detected() {
    let passes = splashdown::passes();
    for left_out in &passes {
        let rest: Vec<_> = passes.iter().copied().filter(|pass| pass.label != left_out.label).collect();
        let wrong = testing::gate(Path::new(SOURCES), &rest);
        let label = format!("({:?})", left_out.label);
        let found = wrong.iter().any(|line| line.contains("`passes()` lacks") && line.contains(&label));
        assert!(found, "{}: {wrong:?}", left_out.label);
    }
}
