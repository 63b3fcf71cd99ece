use glam::Vec3;
use splashdown::scene::Quantity;

use crate::{CUBE, parse};

const BODY: &str = "[[body]]\nname = \"wheel\"\nmesh = \"gear\"\nscale = 0.1\nposition = [0.5, 0.5, 0.5]\n";

#[test]
fn probes_are_read() {
    let text = format!(
        "{CUBE}\n{BODY}[[probe]]\nname = \"p1\"\nquantity = \"pressure\"\nposition = [0.1, 0, 0.2]\ninterval = 0.001\n\
         [[probe]]\nname = \"h1\"\nquantity = \"height\"\nposition = [0.5, 0, 0.5]\n\
         [[probe]]\nname = \"f1\"\nquantity = \"force\"\nbody = \"wheel\"\n\
         [[probe]]\nname = \"q1\"\nquantity = \"flow\"\nposition = [0.5, 0.5, 0.5]\nnormal = [0, 0, 2]\nsize = [0.2, 0.1]\n\
         [[probe]]\nname = \"all\"\nquantity = \"fluid\"\n\
         [[probe]]\nname = \"b1\"\nquantity = \"body\"\nbody = \"wheel\"\ninterval = 0.01\n\
         [[probe]]\nname = \"low\"\nquantity = \"fluid\"\nmin = [0, 0, 0]\nmax = [1, 0.5, 1]\n"
    );
    let scene = parse(&text).unwrap_or_else(|errors| panic!("{errors}"));
    let quantities: Vec<_> = scene.probes.iter().map(|probe| probe.quantity.clone()).collect();
    assert_eq!(quantities[0], Quantity::Pressure(Vec3::new(0.1, 0.0, 0.2)));
    assert_eq!(scene.probes[0].interval, Some(0.001));
    assert_eq!(quantities[1], Quantity::Height(Vec3::new(0.5, 0.0, 0.5)));
    assert_eq!(quantities[2], Quantity::Force("wheel".into()));
    let Quantity::Flow { normal, along, size, .. } = quantities[3] else { panic!("{quantities:?}") };
    assert_eq!((normal, size), (Vec3::Z, [0.2, 0.1]));
    assert!(along.dot(normal).abs() < 1e-6 && along.y.abs() < 1e-6, "{along}");
    assert_eq!(quantities[4], Quantity::Fluid { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY });
    assert_eq!(quantities[5], Quantity::Body("wheel".into()));
    assert_eq!(quantities[6], Quantity::Fluid { min: Vec3::ZERO, max: Vec3::new(1.0, 0.5, 1.0) });
}

#[test]
fn errors_in_probes_are_reported() {
    let probe = |rest: &str| format!("{CUBE}\n{BODY}[[probe]]\nname = \"a\"\n{rest}\n");
    for (text, part) in [
        (probe("quantity = \"pressure\""), "probe[0].position is missing: pressure needs it"),
        (probe("quantity = \"pressure\"\nposition = [0, 9, 0]"), "outside the domain"),
        (probe("quantity = \"presure\"\nposition = [0, 0, 0]"), "did you mean \"pressure\"?"),
        (probe("quantity = \"force\"\nbody = \"wheal\""), "did you mean \"wheel\"?"),
        (probe("quantity = \"body\"\nbody = \"wheal\""), "there is no body called \"wheal\""),
        (probe("quantity = \"body\"\nbody = \"barrel\""), "wheel"),
        (probe("quantity = \"body\""), "probe[0].body is missing: body needs it"),
        (
            probe("quantity = \"force\"\nbody = \"wheel\"\nposition = [0, 0, 0]"),
            "does not apply to quantity = \"force\"",
        ),
        (probe("quantity = \"flow\"\nposition = [0, 0, 0]\nsize = [1, 1]"), "normal is missing"),
        (
            probe(
                "quantity = \"flow\"\nposition = [0, 0, 0]\nsize = [1, 1]\nnormal = [0, 1, 0]\nalong = [0, 1, 1]",
            ),
            "is not perpendicular to the normal",
        ),
        (probe("quantity = \"fluid\"\ninterval = 0.1"), "interval does not apply to quantity = \"fluid\""),
        (probe("quantity = \"fluid\"\nmin = [0, 0, 0]\nmax = [1, 0, 1]"), "max is not above min"),
        (
            probe("quantity = \"height\"\nposition = [0, 0, 0]\ninterval = 1e-6"),
            "more than 10000 rows per frame",
        ),
        (
            format!(
                "{}[[probe]]\nname = \"A\"\nquantity = \"height\"\nposition = [0, 0, 0]\n",
                probe("quantity = \"height\"\nposition = [0, 0, 0]")
            ),
            "the probes \"a\" and \"A\" differ only in case",
        ),
    ] {
        let message = parse(&text).map(drop).expect_err(&text).to_string();
        assert!(message.contains(part), "{text}\n{message}");
    }
}

#[test]
fn a_pressure_probe_near_bodies_with_summed_densities_gives_a_warning() {
    let probe = "[[probe]]\nname = \"a\"\nquantity = \"pressure\"\nposition = [0, 0, 0]\n";
    let body = "[[body]]\nname = \"cube\"\nmesh = \"cube\"\nscale = 0.2\nposition = [0.8, 0.2, 0.8]\n";
    let is_warned = |text: &str| {
        let warnings = parse(text).unwrap_or_else(|errors| panic!("{errors}")).warnings;
        warnings.iter().any(|warning| warning.to_string().contains("pressure near bodies is too low"))
    };
    assert!(is_warned(&format!("{CUBE}\n{body}\n{probe}")));
    assert!(!is_warned(&format!("{CUBE}\n{probe}")));
    let exact = CUBE.replace("[solver]", "[solver]\ndensity = \"continuity\"");
    assert_ne!(exact, CUBE);
    assert!(!is_warned(&format!("{exact}\n{body}\n{probe}")));
}

#[test]
fn an_initial_pressure_without_effect_gives_a_warning() {
    let is_warned = |text: &str| {
        let warnings = parse(text).unwrap_or_else(|errors| panic!("{errors}")).warnings;
        warnings.iter().any(|warning| warning.to_string().contains("initial_pressure has no effect"))
    };
    let explicit = CUBE.replace("[fluid]", "[fluid]\ninitial_pressure = \"hydrostatic\"");
    assert_ne!(explicit, CUBE);
    assert!(!is_warned(&explicit));
    let tilted = |text: &str| text.replace("[scene]", "[scene]\ngravity = [1, -9.81, 0]");
    assert!(is_warned(&tilted(&explicit)));
    // The default is silent.
    assert!(!is_warned(&tilted(CUBE)));
    // Bodies do not prevent it.
    let body = "[[body]]\nname = \"cube\"\nmesh = \"cube\"\nscale = 0.2\nposition = [0.8, 0.2, 0.8]\n";
    assert!(!is_warned(&format!("{explicit}\n{body}")));
}
