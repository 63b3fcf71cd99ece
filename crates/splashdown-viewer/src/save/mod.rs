//! Writing a changed scene as a scene file.

mod files;
mod things;
mod values;

use std::path::Path;

use splashdown::scene::{Choice, Scene, Solver, SurfaceTension};
use toml_edit::{DocumentMut, Item, Table, value};

use crate::camera::Orbit;
use crate::items::{decimal, decimals};
use crate::problem;
use values::{number, vector};

/// The text of the scene's file with the changes; comments and order are preserved.
///
/// # Errors
/// A message, if a scene file cannot express the changes, such as a block outside the domain.
pub fn scene(scene: &Scene, orbit: &Orbit) -> Result<String, String> {
    let source =
        scene.source.as_deref().map_or_else(|| scene.name.clone(), |path| path.display().to_string());
    let folder = scene.source.as_deref().and_then(Path::parent);
    let parse = |text: &str| -> Result<Scene, String> {
        let mut scene = Scene::parse(text, &source).map_err(|errors| problem::of_scene(&errors))?;
        if let Some(folder) = folder {
            scene.resolve_files(folder);
        }
        Ok(scene)
    };
    let old = parse(&scene.text)?;
    let mut document: DocumentMut = scene.text.parse().map_err(|error| format!("{source}: {error}"))?;
    numbers(&mut document, &old, scene);
    camera(&mut document, orbit);
    things::blocks(&mut document, &old.fluid.blocks, &scene.fluid.blocks);
    things::fluid_meshes(&mut document, &old.fluid.meshes, &scene.fluid.meshes)?;
    things::bodies(&mut document, &old.bodies, &scene.bodies)?;
    things::emitters(&mut document, &old.emitters, &scene.emitters)?;
    let written = document.to_string();
    // Reading the text must give the same scene.
    let mut read = parse(&written)?;
    things::adopt_rotations(&mut read, scene);
    read.camera = scene.camera;
    read.source.clone_from(&scene.source);
    read.warnings.clone_from(&scene.warnings);
    read.text = scene.text.clone();
    if read != *scene {
        return Err("this scene has changes that a scene file cannot express".to_owned());
    }
    Ok(written)
}

/// The text of a scene for a file in another folder than that of the scene, from which its meshes and other files are
/// named.
///
/// # Errors
/// A message, if the text is not that of a scene, or the files cannot be named from there.
pub fn moved_to(text: &str, scene: &Scene, path: &Path) -> Result<String, String> {
    let absolute = |folder: Option<&Path>| {
        std::path::absolute(folder.filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new(".")))
    };
    let source = scene.source.as_deref();
    let (from, to) = (absolute(source.and_then(Path::parent)), absolute(path.parent()));
    let (Ok(from), Ok(to)) = (from, to) else { return Err(format!("`{}` is not a path", path.display())) };
    if from == to {
        return Ok(text.to_owned());
    }
    let mut document: DocumentMut = text.parse().map_err(|error| format!("{}: {error}", path.display()))?;
    files::make_absolute(&mut document, &from);
    let moved = document.to_string();
    // The file must give the same scene there.
    Scene::parse_beside(&moved, path).map_err(|errors| problem::of_scene(&errors))?;
    Ok(moved)
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
        let distance = orbit.distance;
        table.insert("target", vector(decimals(orbit.target, distance)));
        table.insert("distance", number(decimal(distance, distance)));
        table.insert("azimuth", number(decimal(orbit.azimuth, 10.0)));
        table.insert("elevation", number(decimal(orbit.elevation, 10.0)));
    }
}

#[cfg(test)]
mod tests {
    use super::scene;
    use crate::camera::Orbit;
    use crate::edit;
    use crate::items::Item;
    use glam::Vec3;
    use splashdown::scene::{Method, Outlet, Scene, presets};

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
            edit::add_emitter(&mut changed);
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
    fn a_removed_thing_whose_name_is_used_again_is_saved() {
        let body = |name: &str, mesh: &str| {
            format!(
                "[[body]]\nname = \"{name}\"\nmesh = \"{mesh}\"\nposition = [0.5, 0.5, 0.5]\nscale = 0.2\n"
            )
        };
        let (name, text) = presets().iter().find(|(name, _)| *name == "dam-break-small").unwrap();
        let emitter = "[[emitter]]\nname = \"emitter-1\"\nshape = \"rectangle\"\nsize = [0.1, 0.1]\nposition = [0.5, 0.5, 0.5]\n\
                       direction = [0, -1, 0]\nspeed = 1\n";
        let text = format!("{text}\n{}{}{emitter}", body("ball-1", "cube"), body("post", "sphere"));
        let mut changed = Scene::parse(&text, name).unwrap();
        Item::Body(0).remove(&mut changed);
        Item::Emitter(0).remove(&mut changed);
        edit::add_ball(&mut changed);
        edit::add_emitter(&mut changed);
        changed.bodies[1].name = "ball-1".to_owned();
        // The same thing again behind the others: it was removed, and added.
        let text = scene(&changed, &Orbit::of_scene(&changed)).unwrap();
        let mut reordered = Scene::parse(&format!("{text}\n{}", body("pillar", "cube")), name).unwrap();
        assert_eq!(reordered.bodies[1].name, "ball-1");
        let ball = reordered.bodies.remove(1);
        reordered.bodies.push(ball);
        for changed in [changed, reordered] {
            let saved = scene(&changed, &Orbit::of_scene(&changed)).unwrap();
            let read = Scene::parse(&saved, name).unwrap();
            assert_eq!((&read.bodies, &read.emitters), (&changed.bodies, &changed.emitters), "{saved}");
        }
    }

    #[test]
    fn resized_and_rotated_things_of_every_scene_are_saved() {
        use glam::{EulerRot, Quat};
        let mut saved = 0;
        // Also at the poles of the angles, where two of them have the same axis.
        let turns = [[0.0, 90.0, 0.0], [10.0, -90.0, 30.0], [33.0, 44.0, 55.0], [179.9, -12.5, -178.0]];
        for (name, text) in presets() {
            let original = Scene::parse(text, name).unwrap();
            for (item, turn) in Item::all(&original).into_iter().zip(turns.into_iter().cycle()) {
                if !item.is_movable(&original) {
                    continue;
                }
                let mut changed = original.clone();
                let [x, y, z] = turn.map(f32::to_radians);
                item.rotate_by(&mut changed, Quat::from_euler(EulerRot::ZYX, z, y, x), Vec3::ZERO);
                item.scale_by(
                    &mut changed,
                    0.875,
                    item.bounds(&original, &Default::default()).unwrap_or_default().0,
                );
                edit::add_ball(&mut changed);
                let ball = Item::Body(changed.bodies.len() - 1);
                ball.rotate_by(&mut changed, Quat::from_rotation_z(1.0), Vec3::ONE);
                let Ok(text) = scene(&changed, &Orbit::of_scene(&changed)) else { continue };
                let read = Scene::parse(&text, name).unwrap();
                assert_eq!(read.fluid.blocks, changed.fluid.blocks, "{name}: {item:?}");
                for (a, b) in read.bodies.iter().zip(&changed.bodies) {
                    assert!(a.mesh.rotation.dot(b.mesh.rotation).abs() > 1.0 - 1e-6, "{name}: {item:?}");
                    assert_eq!((a.mesh.position, a.mesh.scale), (b.mesh.position, b.mesh.scale), "{name}");
                }
                saved += usize::from(changed != original);
            }
        }
        assert!(saved > 15, "only {saved} changes were saved");
    }

    #[test]
    fn the_directions_and_sizes_of_emitters_are_saved_with_few_digits() {
        let (name, text) = presets().iter().find(|(name, _)| *name == "dam-break-small").unwrap();
        let emitter = |name: &str, size: &str| {
            format!(
                "[[emitter]]\nname = \"{name}\" # an outlet\n{size}\nposition = [0.5, 0.5, 0.4]\ndirection = [0, -1, 0]\nspeed = 1\n"
            )
        };
        let [disc, slot] = [("disc", "radius = 0.1"), ("slot", "shape = \"rectangle\"\nsize = [0.2, 0.1]")];
        let text = format!("{text}\n{}{}", emitter(disc.0, disc.1), emitter(slot.0, slot.1));
        let mut changed = Scene::parse(&text, name).unwrap();
        for index in 0..2 {
            Item::Emitter(index).rotate_by(&mut changed, glam::Quat::from_rotation_x(0.7), Vec3::ZERO);
            changed.emitters[index].speed = 2.5;
        }
        changed.emitters[0].outlet = Outlet::Disc { radius: 0.12 };
        changed.emitters[1].outlet = Outlet::Rectangle { size: [0.3, 0.15] };
        let saved = scene(&changed, &Orbit::of_scene(&changed)).unwrap();
        let read = Scene::parse(&saved, name).unwrap();
        for (a, b) in read.emitters.iter().zip(&changed.emitters) {
            assert_eq!((&a.name, &a.outlet, a.speed), (&b.name, &b.outlet, b.speed), "{saved}");
            assert!(a.direction.distance(b.direction) < 1e-6, "{saved}");
        }
        assert_eq!(saved.matches("# an outlet").count(), text.matches("# an outlet").count(), "{saved}");
        // Control: single precision has more digits.
        assert!(changed.emitters[0].direction.y.to_string().len() > 9);
        let added: Vec<&str> = saved.lines().filter(|line| !text.contains(line)).collect();
        let digits = |word: &str| word.chars().filter(char::is_ascii_digit).count();
        let numbers = added.iter().flat_map(|line| line.split([' ', ',', '[', ']']));
        assert!(numbers.clone().count() > 20 && numbers.clone().all(|word| digits(word) <= 8), "{added:#?}");
    }

    #[test]
    fn the_files_of_a_scene_are_found_from_another_folder() {
        let folder = tempfile::tempdir().unwrap();
        let [from, to] = ["from", "to"].map(|name| folder.path().join(name));
        for folder in [&from, &to] {
            std::fs::create_dir(folder).unwrap();
        }
        let (_, text) = presets().iter().find(|(name, _)| *name == "dam-break-small").unwrap();
        let body = "\n[[body]]\nname = \"tent\"\nmesh = \"tent.obj\" # a tetrahedron\nposition = [0.5, 0.2, 0.3]\nscale = 0.1\n";
        std::fs::write(from.join("a.toml"), format!("{text}{body}")).unwrap();
        let tent = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
        std::fs::write(from.join("tent.obj"), tent).unwrap();
        let mut changed = Scene::load(from.join("a.toml")).unwrap();
        Item::Body(0).move_by(&mut changed, Vec3::Y * 0.1);
        edit::add_fluid_mesh(&mut changed, from.join("tent.obj"), [Vec3::ZERO, Vec3::ONE]);
        let saved = scene(&changed, &Orbit::of_scene(&changed)).unwrap();
        // In its own folder the scene still names the file as before.
        assert!(saved.contains("\"tent.obj\" # a tetrahedron"), "{saved}");
        assert_eq!(super::moved_to(&saved, &changed, &from.join("b.toml")).unwrap(), saved);
        let moved = super::moved_to(&saved, &changed, &to.join("b.toml")).unwrap();
        std::fs::write(to.join("b.toml"), moved).unwrap();
        let read = Scene::load(to.join("b.toml")).unwrap();
        assert_eq!((&read.bodies, &read.fluid), (&changed.bodies, &changed.fluid));
        // Control: the same text does not find the file there.
        assert!(Scene::parse_beside(&saved, &to.join("b.toml")).is_err());
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
