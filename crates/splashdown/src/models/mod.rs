//! Built-in meshes, all of which are computed rather than read from files.
//!
//! Most are defined by a signed distance function (`shape`), which marching cubes converts into triangles
//! (`polygonise`). The simple ones are built triangle by triangle (`direct`). All are closed, manifold and
//! oriented outwards, except `thin-cup`, which is a sheet without thickness. Lengths are in metres and y
//! points up. Standing models have their base at y = 0 and their axis through the origin; floating models
//! have their centre of mass at the origin.
//!
//! `ugly` damages a mesh, for tests of mesh repair.

mod boats;
mod crockery;
mod curves;
mod direct;
mod figure;
mod lighthouse;
mod machines;
mod polygonise;
mod rock;
mod shape;
#[cfg(test)]
mod tests;
mod ugly;

use std::sync::OnceLock;

use splashdown_io::Mesh;

pub use ugly::ugly;

/// A model: its name, its description, and the function that builds it.
type Model = (&'static str, &'static str, fn() -> Mesh);

const MODELS: &[Model] = &[
    ("lighthouse", "lighthouse on a rock, with gallery and lantern room, 1 m high", lighthouse::lighthouse),
    ("figure", "statue of a woman in a long robe with a jar on her head, 1 m high", figure::figure),
    ("hull", "small tug with a solid hull, bulwark, wheelhouse and funnel, 0.6 m long; floats", boats::hull),
    ("buoy", "beacon buoy with a counterweight, 0.66 m high; floats", boats::buoy),
    ("cup", "mug with thick walls and a handle, 0.1 m high, open on top", crockery::cup),
    ("thin-cup", "beaker without thickness (an open sheet), 0.1 m high", crockery::thin_cup),
    (
        "thin-cup-filling",
        "inside of thin-cup up to its rim, 0.1 m high, to be filled with fluid",
        crockery::thin_cup_filling,
    ),
    (
        "spout",
        "bent pipe with a flange; its outlet, 0.06 m wide, is at the origin and points down",
        machines::spout,
    ),
    ("gear", "spur gear of 20 teeth with a bore, 0.44 m across, axis along z", machines::gear),
    ("paddle-wheel", "wheel with 12 paddles, 0.5 m across, axis along z", machines::paddle_wheel),
    ("drum", "mixing drum with 6 lifters, 0.5 m across, axis along z, open at +z", machines::drum),
    ("torus-knot", "trefoil knot of round rope, 0.6 m across, in the xy plane", curves::torus_knot),
    ("sphere", "sphere, 0.2 m across", curves::sphere),
    ("block", "cube of 0.2 m with rounded edges, centred at the origin", curves::block),
    ("cube", "cube of 1 m with sharp edges, centred at the origin", direct::cube),
    ("marin-box", "obstacle of SPHERIC test 2, 0.161 m x 0.161 m high x 0.403 m along z", direct::marin_box),
    ("ramp", "wedge, 1 m long, 0.5 m wide, rising to 0.3 m towards +x", direct::ramp),
    ("steps", "five stairs, 1 m long, 0.5 m wide, rising to 0.5 m towards +x", direct::steps),
];

/// The names of the models, each with a one-line description that includes the size in m.
#[must_use]
pub fn names() -> &'static [(&'static str, &'static str)] {
    const NAMES: [(&str, &str); MODELS.len()] = {
        let mut names = [("", ""); MODELS.len()];
        let mut i = 0;
        while i < names.len() {
            names[i] = (MODELS[i].0, MODELS[i].1);
            i += 1;
        }
        names
    };
    &NAMES
}

/// The model of this name (one of [`names`]) in m; `None` for an unknown name. The mesh of a name is always
/// bit-identical. It is computed once per process and then copied, because some models take half a second.
#[must_use]
pub fn build(name: &str) -> Option<Mesh> {
    static BUILT: [OnceLock<Mesh>; MODELS.len()] = [const { OnceLock::new() }; MODELS.len()];
    let index = MODELS.iter().position(|(known, ..)| *known == name)?;
    Some(BUILT[index].get_or_init(MODELS[index].2).clone())
}
