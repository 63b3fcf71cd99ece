//! Writing a changed scene as a scene file.

mod things;
mod values;

use splashdown::scene::{Choice, Scene, Solver, SurfaceTension};
use toml_edit::{DocumentMut, Item, Table, value};

use crate::camera::Orbit;
use values::{number, vector};

/// The text of the scene's file with the changes; comments and order are preserved.
///
/// # Errors
/// A message, if a scene file cannot express the changes, such as a block outside the domain.
pub fn scene(scene: &Scene, orbit: &Orbit) -> Result<String, String> {
    let source =
        scene.source.as_deref().map_or_else(|| scene.name.clone(), |path| path.display().to_string());
    let old = Scene::parse(&scene.text, &source).map_err(|error| error.to_string())?;
    let mut document: DocumentMut = scene.text.parse().map_err(|error| format!("{source}: {error}"))?;
    numbers(&mut document, &old, scene);
    camera(&mut document, orbit);
    things::blocks(&mut document, &old.fluid.blocks, &scene.fluid.blocks);
    things::bodies(&mut document, &old.bodies, &scene.bodies)?;
    things::emitters(&mut document, &old.emitters, &scene.emitters)?;
    let written = document.to_string();
    // Reading the text must give the same scene.
    let mut read = Scene::parse(&written, &source).map_err(|error| error.to_string())?;
    read.camera = scene.camera;
    read.source.clone_from(&scene.source);
    read.warnings.clone_from(&scene.warnings);
    read.text = scene.text.clone();
    if read != *scene {
        return Err("this scene has changes that a scene file cannot express".to_owned());
    }
    Ok(written)
}

fn numbers(document: &mut DocumentMut, old: &Scene, new: &Scene) {
    let is_other_method = old.solver.method != new.solver.method;
    if is_other_method && let Some(table) = document.get_mut("solver").and_then(Item::as_table_like_mut) {
        // Keys of the old method. The other method has its own defaults, or does not know them.
        let numerical = ["accuracy", "kernel", "artificial_viscosity", "cfl_factor", "max_dt"];
        let implicit = ["tolerance", "max_iterations"];
        for key in numerical.iter().chain(&implicit).chain(&Solver::NOT_IMPLICIT) {
            table.remove(key);
        }
    }
    if new.solver.surface_tension != SurfaceTension::Csf
        && let Some(table) = document.get_mut("solver").and_then(Item::as_table_like_mut)
    {
        table.remove("contact_angle");
    }
    let mut set = |section: &str, key: &str, differs: bool, item: Item| {
        if differs {
            let section = document.entry(section).or_insert(Item::Table(Table::new()));
            if let Some(table) = section.as_table_like_mut() {
                table.insert(key, item);
            }
        }
    };
    set("scene", "duration", old.duration != new.duration, number(new.duration));
    set("scene", "gravity", old.gravity != new.gravity, vector(new.gravity));
    let (a, b) = (&old.fluid, &new.fluid);
    let spacing = number(b.particle_spacing);
    set("fluid", "particle_spacing", a.particle_spacing != b.particle_spacing, spacing);
    let (a, b) = (&a.material, &b.material);
    set("fluid", "material", a.name != b.name, value(&b.name));
    set("fluid", "density", a.rest_density != b.rest_density, number(b.rest_density));
    set("fluid", "viscosity", a.viscosity != b.viscosity, number(b.viscosity));
    set("fluid", "surface_tension", a.surface_tension != b.surface_tension, number(b.surface_tension));
    let (a, b) = (&old.solver, &new.solver);
    set("solver", "method", is_other_method, value(b.method.name()));
    set("solver", "support_ratio", is_other_method, number(b.support_ratio));
    if let Some(speed) = b.sound_speed {
        set("solver", "sound_speed", is_other_method, number(speed));
    }
    let model = value(b.surface_tension.name());
    set("solver", "surface_tension", a.surface_tension != b.surface_tension, model);
    let damping = number(b.artificial_viscosity);
    let usual = if is_other_method { &Solver::with(b.method, b.density) } else { a };
    set("solver", "artificial_viscosity", usual.artificial_viscosity != b.artificial_viscosity, damping);
    set("solver", "cfl_factor", usual.cfl_factor != b.cfl_factor, number(b.cfl_factor));
    set("solver", "max_dt", usual.max_dt != b.max_dt, number(b.max_dt));
    set("solver", "wall_friction", a.wall_friction != b.wall_friction, number(b.wall_friction));
    let (a, b) = (&old.surface, &new.surface);
    set("surface", "cell_size", a.cell_size != b.cell_size || old.fluid != new.fluid, number(b.cell_size));
    set("foam", "enabled", old.foam.enabled != new.foam.enabled, value(new.foam.enabled));
    set("surface", "min_blob", a.min_blob != b.min_blob, value(i64::from(b.min_blob)));
    let iterations = value(i64::from(b.smoothing_iterations));
    set("surface", "smoothing_iterations", a.smoothing_iterations != b.smoothing_iterations, iterations);
}

fn camera(document: &mut DocumentMut, orbit: &Orbit) {
    let section = document.entry("camera").or_insert(Item::Table(Table::new()));
    if let Some(table) = section.as_table_like_mut() {
        table.insert("target", vector(orbit.target));
        table.insert("distance", number(orbit.distance));
        table.insert("azimuth", number(orbit.azimuth));
        table.insert("elevation", number(orbit.elevation));
    }
}

#[cfg(test)]
mod tests {
    use super::scene;
    use crate::camera::Orbit;
    use crate::edit;
    use crate::items::Item;
    use glam::Vec3;
    use splashdown::scene::{Method, Scene, presets};

    #[test]
    fn changes_of_every_scene_are_saved() {
        for (name, text) in presets() {
            let mut changed = Scene::parse(text, name).unwrap();
            changed.gravity = Vec3::new(0.1, -9.0, 1.0 / 3.0);
            changed.fluid.particle_spacing *= 1.1;
            changed.surface.cell_size *= 1.1;
            changed.surface.min_blob = 4;
            changed.fluid.material.viscosity = 1.0 / 700.0;
            changed.solver.select_method(Method::Wcsph);
            changed.solver.artificial_viscosity = 0.07;
            edit::add_ball(&mut changed);
            edit::turn_tap(&mut changed);
            let mut orbit = Orbit::of_scene(&changed);
            orbit.azimuth = 77.0;
            let saved = scene(&changed, &orbit).unwrap_or_else(|error| panic!("{name}: {error}"));
            let read = Scene::parse(&saved, name).unwrap();
            assert_eq!(read.camera.azimuth, 77.0, "{name}");
            assert_eq!(read.bodies, changed.bodies, "{name}");
            assert_eq!(read.surface.min_blob, 4, "{name}");
            // Comments are preserved.
            assert_eq!(text.lines().next(), saved.lines().next(), "{name}");
        }
    }

    #[test]
    fn moved_removed_and_added_things_of_every_scene_are_saved() {
        let mut saved = 0;
        for (name, text) in presets() {
            let original = Scene::parse(text, name).unwrap();
            let all = Item::all(&original);
            for &item in &all {
                let mut changes = vec![original.clone(); 2];
                // A small offset along the longest way to a wall stays inside the domain.
                let up = Vec3::Y * original.fluid.particle_spacing;
                item.move_by(&mut changes[0], if item.is_movable(&original) { up } else { Vec3::ZERO });
                item.remove(&mut changes[1]);
                edit::add_ball(&mut changes[1]);
                for changed in changes {
                    // Probes may name a body, and a scene needs some fluid.
                    let Ok(text) = scene(&changed, &Orbit::of_scene(&changed)) else { continue };
                    let read = Scene::parse(&text, name).unwrap();
                    assert_eq!(read.fluid.blocks, changed.fluid.blocks, "{name}: {item:?}");
                    assert_eq!(read.bodies, changed.bodies, "{name}: {item:?}");
                    assert_eq!(read.emitters, changed.emitters, "{name}: {item:?}");
                    saved += 1;
                }
            }
        }
        assert!(saved > 40, "only {saved} changes were saved");
    }

    #[test]
    fn a_block_outside_the_domain_is_refused_with_the_reason() {
        let (name, text) = presets()[0];
        let mut changed = Scene::parse(text, name).unwrap();
        Item::Block(0).move_by(&mut changed, Vec3::X * 100.0);
        let refused = scene(&changed, &Orbit::of_scene(&changed));
        assert!(refused.as_ref().is_err_and(|reason| reason.contains("domain")), "{refused:?}");
    }

    #[test]
    fn another_method_of_an_accurate_scene_is_saved() {
        let keys = "\n[solver]\naccuracy = \"engineering\"\ndensity_diffusion = 0.2\nwall_friction = 0.5\n";
        let (_, floating) = presets().iter().find(|(name, _)| *name == "floating").unwrap();
        let text = format!("{floating}{keys}");
        let mut changed = Scene::parse(&text, "accurate.toml").unwrap();
        assert_eq!(changed.solver.support_ratio, 3.0);
        changed.solver.select_method(Method::Mueller2003);
        let saved = scene(&changed, &Orbit::of_scene(&changed)).unwrap();
        let read = Scene::parse(&saved, "accurate.toml").unwrap();
        assert_eq!((&read.solver, read.solver.wall_friction), (&changed.solver, 0.5), "{saved}");
    }

    #[test]
    fn another_surface_tension_is_saved_without_a_contact_angle() {
        let keys = "\n[solver]\nsurface_tension = \"csf\"\ncontact_angle = 120\n";
        let (_, floating) = presets().iter().find(|(name, _)| *name == "floating").unwrap();
        let old = Scene::parse(&format!("{floating}{keys}"), "wet.toml").unwrap();
        let saved = |method| {
            let mut changed = old.clone();
            changed.solver.select_method(method);
            let saved = scene(&changed, &Orbit::of_scene(&changed)).unwrap();
            Scene::parse(&saved, "wet.toml").unwrap().solver.contact_angle
        };
        assert_eq!((saved(Method::Wcsph), saved(Method::Mueller2003)), (120.0, 90.0));
    }

    #[test]
    fn changes_that_a_scene_file_cannot_express_are_refused() {
        let (name, text) = presets()[0];
        let mut changed = Scene::parse(text, name).unwrap();
        changed.domain.max.x *= 2.0;
        let orbit = Orbit::of_scene(&changed);
        assert!(scene(&changed, &orbit).is_err());
    }
}
