//! Assembly of WGSL: the line `#import name` pastes a shared module once, and the line `#bindings` declares the
//! bindings of the pass.

use std::collections::HashSet;

use crate::Binding;

/// A named piece of WGSL that passes may import.
#[derive(Clone, Copy, Debug)]
pub struct WgslModule {
    /// The name, e.g. `"gpu/index"`.
    pub name: &'static str,
    /// Its text, which may import other modules.
    pub source: &'static str,
}

/// `linear_index` and `linear_group`: one-dimensional indices in a two-dimensional dispatch.
pub const INDEX: WgslModule = WgslModule { name: "gpu/index", source: include_str!("index.wgsl") };

/// `workgroup_prefix`: prefix sums over the 256 invocations of a workgroup with two barriers. It declares
/// workgroup memory.
pub const WORKGROUP_PREFIX: WgslModule =
    WgslModule { name: "gpu/workgroup_prefix", source: include_str!("workgroup_prefix.wgsl") };

/// Replaces `#import` lines by the modules they name, each pasted once, and the line `#bindings` by the declarations
/// of these bindings.
///
/// # Errors
/// The name of a module that is not in `modules`.
pub fn expand(source: &str, modules: &[WgslModule], bindings: &[Binding]) -> Result<String, String> {
    let mut out = String::new();
    expand_into(source, modules, bindings, &mut HashSet::new(), &mut out)?;
    Ok(out)
}

fn expand_into<'a>(
    source: &'a str,
    modules: &[WgslModule],
    bindings: &[Binding],
    seen: &mut HashSet<&'a str>,
    out: &mut String,
) -> Result<(), String> {
    for line in source.lines() {
        if let Some(name) = line.strip_prefix("#import ").map(str::trim) {
            if seen.insert(name) {
                let module = modules
                    .iter()
                    .find(|module| module.name == name)
                    .ok_or_else(|| format!("it imports {name:?}, which is not one of its modules"))?;
                expand_into(module.source, modules, &[], seen, out)?;
            }
        } else if line.trim_end() == "#bindings" {
            for (number, binding) in bindings.iter().enumerate() {
                out.push_str(&binding.wgsl(number));
                out.push('\n');
            }
        } else {
            out.push_str(line);
        }
        out.push('\n');
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use glam::Vec4;

    use super::*;
    use crate::bindings;

    bindings! {
        struct Bindings {
            table: uniform [Vec4; 3],
            starts: read [u32],
            counts: atomic [u32],
        }
    }

    #[test]
    fn a_module_is_pasted_once_and_an_unknown_module_is_reported() {
        let modules = [
            WgslModule { name: "a", source: "#import b\nconst A = 1;" },
            WgslModule { name: "b", source: "const B = 2;" },
        ];
        let text = expand("#import a\n#import b\nfn f() {}", &modules, &[]).unwrap();
        assert_eq!(text.matches("const B").count(), 1);
        assert!(text.find("const B").unwrap() < text.find("const A").unwrap());
        assert!(expand("#import c", &modules, &[]).unwrap_err().contains("\"c\""));
    }

    #[test]
    fn bindings_are_declared_with_numbers_spaces_and_types() {
        let text = expand("// before\n#bindings\n// after", &[], Bindings::LIST).unwrap();
        assert_eq!(
            text,
            "// before
@group(0) @binding(0) var<uniform> table: array<vec4<f32>, 3>;
@group(0) @binding(1) var<storage, read> starts: array<u32>;
@group(0) @binding(2) var<storage, read_write> counts: array<atomic<u32>>;

// after
"
        );
    }
}
