//! The output formats of scene files agree with the table of file formats.

use splashdown::scene::{Choice, Format};

#[test]
fn every_written_format_can_be_named_in_a_scene() {
    let named: Vec<&str> = Format::ALL.iter().map(|(format, ..)| format.ending()).collect();
    for file in splashdown_io::Format::ALL {
        let is_written = file.writes_particles() || file.writes_meshes();
        assert_eq!(named.contains(&&file.ending[1..]), is_written, "{}", file.ending);
    }
    for &(format, name, about) in Format::ALL {
        assert!(format.has_particles() || format.has_surface(), "`{name}` is not in the table");
        assert_eq!(format.has_particles(), about.contains("particles"), "{name}: {about}");
        assert_eq!(format.has_surface(), about.contains("the surface"), "{name}: {about}");
        assert_eq!(format.is_numbered(), format != Format::Usd, "{name}");
    }
}
