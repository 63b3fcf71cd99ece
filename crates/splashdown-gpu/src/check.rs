//! The gate: compares a pass's declaration with its WGSL, without a GPU.
//!
//! It parses and validates the WGSL with `naga` and compares entry point, workgroup size, override constants
//! and, for every binding, number, name, access, element type as spelled, size, and a struct's members with
//! their offsets, sizes and scalars. Every binding must be used, and every writable one written. The tests contain one
//! mutation for each of these, which the gate must catch.

use naga::proc::Layouter;
use naga::valid::{FunctionInfo, GlobalUse};
use naga::{AddressSpace, Handle, Module, StorageAccess, StructMember, Type, TypeInner};

use crate::{Access, Binding, Field, PassDesc};

/// Most storage buffers of a pass, so that it runs in every browser.
pub const MAX_STORAGE_BUFFERS: usize = 8;
/// Most invocations of a workgroup, so that it runs in every browser.
pub const MAX_INVOCATIONS: u32 = 256;

/// Compares a pass with its WGSL.
///
/// # Errors
/// A description of the first difference.
pub fn check(pass: &PassDesc) -> Result<(), String> {
    check_source(pass, &pass.source()?)
}

/// Compares a declaration with the limits of browsers.
fn check_limits(pass: &PassDesc) -> Result<(), String> {
    if pass.invocations() > MAX_INVOCATIONS {
        return Err(format!("{} invocations; browsers grant {MAX_INVOCATIONS}", pass.invocations()));
    }
    let storage = pass.bindings.iter().filter(|b| b.access != Access::Uniform).count();
    if storage > MAX_STORAGE_BUFFERS {
        return Err(format!("{storage} storage buffers; browsers grant {MAX_STORAGE_BUFFERS}"));
    }
    Ok(())
}

/// Compares a pass with this WGSL, in which imports and bindings are expanded.
///
/// # Errors
/// A description of the first difference.
pub fn check_source(pass: &PassDesc, source: &str) -> Result<(), String> {
    check_limits(pass)?;
    let module = naga::front::wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?;
    let info =
        naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty())
            .validate(&module)
            .map_err(|error| error.emit_to_string(source))?;
    let [entry] = module.entry_points.as_slice() else {
        return Err(format!("{} entry points; a pass has one", module.entry_points.len()));
    };
    if entry.stage != naga::ShaderStage::Compute {
        return Err(format!("`{}` is not a compute shader", entry.name));
    }
    if entry.name != pass.entry {
        return Err(format!("entry point `{}` in WGSL, `{}` in Rust", entry.name, pass.entry));
    }
    if entry.workgroup_size != pass.workgroup_size {
        return Err(format!(
            "workgroup {:?} in WGSL, {:?} in Rust",
            entry.workgroup_size, pass.workgroup_size
        ));
    }
    for (name, _) in pass.constants {
        if !module.overrides.iter().any(|(_, o)| o.name.as_deref() == Some(name)) {
            return Err(format!("no `override {name}` in the WGSL"));
        }
    }
    for (_, constant) in module.overrides.iter().filter(|(_, constant)| constant.init.is_none()) {
        let name = constant.name.as_deref().unwrap_or_default();
        if !pass.constants.iter().any(|(given, _)| *given == name) {
            return Err(format!("`override {name}` has no value, in WGSL or in Rust"));
        }
    }
    check_bindings(pass, &module, info.get_entry_point(0))
}

fn check_bindings(pass: &PassDesc, module: &Module, info: &FunctionInfo) -> Result<(), String> {
    let mut layouter = Layouter::default();
    layouter.update(module.to_ctx()).map_err(|error| error.to_string())?;
    let mut found = 0;
    for (_, variable) in module.global_variables.iter() {
        let Some(place) = &variable.binding else { continue };
        let name = variable.name.as_deref().unwrap_or_default();
        if place.group != 0 {
            return Err(format!("`{name}` is in group {}; passes use group 0", place.group));
        }
        let declared = pass
            .bindings
            .get(place.binding as usize)
            .ok_or_else(|| format!("`{name}` has binding {}, which Rust does not declare", place.binding))?;
        if name != declared.name {
            return Err(format!("binding {}: `{name}` in WGSL, `{}` in Rust", place.binding, declared.name));
        }
        let access = match variable.space {
            AddressSpace::Uniform => Access::Uniform,
            AddressSpace::Storage { access } if access.contains(StorageAccess::STORE) => Access::ReadWrite,
            _ => Access::Read,
        };
        if access != declared.access {
            return Err(format!("`{name}`: {access:?} in WGSL, {:?} in Rust", declared.access));
        }
        let (element, size) = match module.types[variable.ty].inner {
            TypeInner::Array { base, stride, .. } => (base, stride as usize),
            _ => (variable.ty, layouter[variable.ty].size as usize),
        };
        check_element(declared, module, element, size, &layouter)?;
        found += 1;
    }
    if found != pass.bindings.len() {
        return Err(format!("{found} bindings in WGSL, {} in Rust", pass.bindings.len()));
    }
    check_usage(pass, module, info)
}

/// Every binding is used, and every writable one written.
fn check_usage(pass: &PassDesc, module: &Module, info: &FunctionInfo) -> Result<(), String> {
    for (handle, variable) in module.global_variables.iter() {
        let Some(place) = &variable.binding else { continue };
        let Binding { name, access, .. } = pass.bindings[place.binding as usize];
        let usage = info[handle];
        if usage.is_empty() {
            return Err(format!("`{name}` is bound and never used"));
        }
        if access == Access::ReadWrite && !usage.intersects(GlobalUse::WRITE | GlobalUse::ATOMIC) {
            return Err(format!("`{name}` is bound as writable and never written"));
        }
    }
    Ok(())
}

fn check_element(
    declared: &Binding,
    module: &Module,
    element: Handle<Type>,
    size: usize,
    layouter: &Layouter,
) -> Result<(), String> {
    let name = declared.name;
    let spelled = spell(module, element);
    if spelled != declared.element {
        return Err(format!("`{name}`: {spelled} in WGSL, {} in Rust", declared.element));
    }
    if size != declared.size {
        return Err(format!("`{name}`: {size} bytes in WGSL, {} in Rust", declared.size));
    }
    if let TypeInner::Struct { members, .. } = &module.types[element].inner {
        check_members(&spelled, declared.fields, members, module, layouter)?;
    }
    Ok(())
}

fn check_members(
    name: &str,
    declared: &[Field],
    members: &[StructMember],
    module: &Module,
    layouter: &Layouter,
) -> Result<(), String> {
    let in_wgsl: Vec<String> = members
        .iter()
        .map(|m| {
            let (offset, size) = (m.offset, layouter[m.ty].size);
            line(m.name.as_deref().unwrap_or_default(), offset as usize, size as usize, &scalar(module, m.ty))
        })
        .collect();
    let in_rust: Vec<String> = declared.iter().map(|f| line(f.name, f.offset, f.size, f.scalar)).collect();
    if in_wgsl != in_rust {
        return Err(format!(
            "struct {name} is\n  {}\nin WGSL, and\n  {}\nin Rust",
            in_wgsl.join("\n  "),
            in_rust.join("\n  ")
        ));
    }
    Ok(())
}

/// A member as text, to compare and to show.
fn line(name: &str, offset: usize, size: usize, scalar: &str) -> String {
    format!("{name}: {size} bytes of {scalar} at {offset}")
}

/// The scalar of a member, as in [`Field::scalar`].
fn scalar(module: &Module, ty: Handle<Type>) -> String {
    match &module.types[ty].inner {
        TypeInner::Vector { scalar, .. } | TypeInner::Matrix { scalar, .. } => spell_scalar(*scalar),
        TypeInner::Array { base, .. } => scalar(module, *base),
        _ => spell(module, ty),
    }
}

/// A type as WGSL spells it; atomics count as their integer.
fn spell(module: &Module, ty: Handle<Type>) -> String {
    match &module.types[ty].inner {
        TypeInner::Scalar(s) | TypeInner::Atomic(s) => spell_scalar(*s),
        TypeInner::Vector { size, scalar: s } => format!("vec{}<{}>", *size as u8, spell_scalar(*s)),
        _ => module.types[ty].name.clone().unwrap_or_default(),
    }
}

fn spell_scalar(scalar: naga::Scalar) -> String {
    use naga::ScalarKind::{Float, Sint, Uint};
    match (scalar.kind, scalar.width) {
        (Float, 4) => "f32".to_owned(),
        (Uint, 4) => "u32".to_owned(),
        (Sint, 4) => "i32".to_owned(),
        other => format!("{other:?}"),
    }
}
