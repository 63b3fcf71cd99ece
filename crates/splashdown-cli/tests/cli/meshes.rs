//! `splashdown check` on scenes with meshes.

use serde_json::Value;

use crate::place::{Outcome, Place, stderr, stdout};

const SCENE: &str = "\
[scene]
name = \"meshes\"
duration = 1
[domain]
min = [0, 0, 0]
max = [1, 0.4, 0.4]
[fluid]
particle_spacing = 0.04
[[fluid.block]]
position = [0, 0, 0]
size = [0.4, 0.2, 0.4]
[[fluid.mesh]]
mesh = \"sphere\"
position = [0.8, 0.2, 0.2]
[[body]]
name = \"beaker\"
mesh = \"thin-cup\"
position = [0.2, 0.3, 0.2]
[[body]]
name = \"piston\"
mesh = \"cube\"
scale = 0.4
position = [0.62, 0.2, 0.2]
motion = \"scripted\"
move = [\"-0.3*min(t, 1)\", \"0\", \"0\"]
";

#[test]
fn the_interpretation_of_every_mesh_is_printed() -> Outcome {
    let place = Place::new()?;
    place.write("meshes.toml", SCENE)?;
    let output = place.splashdown(&["check", "meshes.toml", "--device", "cpu"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    let text = stdout(&output);
    let line = |word: &str| text.lines().find(|line| line.contains(word)).unwrap_or_default().to_owned();
    assert!(line("body \"beaker\":").contains("open edges, about"), "{text}");
    assert!(line("body \"piston\":").contains("12 triangles in 1 pieces; treated as a solid"), "{text}");
    assert!(line("fluid.mesh[0]").contains("treated as a solid"), "{text}");
    assert!(line("closes the volume at x_min").contains("shrinks"), "{text}");
    assert!(stderr(&output).contains("body \"piston\" closes the volume at x_min"), "{}", stderr(&output));
    let output = place.splashdown(&["check", "meshes.toml", "--device", "cpu", "--json"]).output()?;
    let report: Value = serde_json::from_slice(&output.stdout)?;
    let meshes = report["meshes"].as_array().ok_or("no meshes")?;
    assert_eq!(meshes.len(), 3);
    assert_eq!((&meshes[0]["shell"], &meshes[1]["shell"]), (&Value::Bool(true), &Value::Bool(false)));
    assert_eq!(meshes[1]["closed_volumes"][0]["side"], "x_min");
    Ok(())
}
