//! A statue: a woman in a long robe who carries a jar on her head.

use glam::{Vec3, Vec3Swizzles as _, vec2, vec3};
use splashdown_io::Mesh;

use super::polygonise::polygonise;
use super::shape::{bone, cut, cylinder, ellipsoid, join, lathe, profile, ring, smooth_step};

pub(super) fn figure() -> Mesh {
    let jar = profile(&[
        [0.0, 0.884],
        [0.022, 0.884],
        [0.034, 0.893],
        [0.049, 0.918],
        [0.051, 0.935],
        [0.044, 0.957],
        [0.027, 0.974],
        [0.023, 0.984],
        [0.03, 0.994],
        [0.0, 0.994],
    ]);
    polygonise(vec3(-0.2, -0.02, -0.19), vec3(0.2, 1.02, 0.19), 0.0064, |p| {
        let base = cylinder(p, 0.148, 0.0, 0.03, 0.006);
        let base = join(base, cylinder(p, 0.132, 0.02, 0.066, 0.006), 0.008);
        let jar = lathe(p, &jar, 0.003);
        let jar = cut(jar, ellipsoid(p - vec3(0.0, 1.0, 0.0), vec3(0.02, 0.035, 0.02)), 0.006);
        join(join(robe(p), base, 0.01), join(body(p), jar, 0.006), 0.018)
    })
}

/// The skirt, from the plinth to the waist: folds that run down and out, and a train at the back.
fn robe(p: Vec3) -> f32 {
    let t = ((p.y - 0.06) / 0.5).clamp(0.0, 1.0);
    // The weight is on one leg: the hips are off centre, and the other knee shows through the cloth.
    let q = p.xz() - vec2(0.012 * smooth_step(0.1, 0.45, p.y), -0.012 * (1.0 - t));
    let angle = q.y.atan2(q.x);
    let fold = (11.0 * angle + 1.2 * (2.0 * angle).sin() + 3.0 * t).cos();
    let fold = fold + 0.45 * (5.0 * angle - 4.0 * t).sin();
    let width = 0.064 + 0.048 * (1.0 - t).powf(1.6) + 0.022 * (-(t - 0.72).powi(2) / 0.035).exp();
    let radius = width + 0.0075 * (1.0 - t).powf(0.8) * fold;
    let round = (q / vec2(1.0, 0.84)).length() - radius;
    let wall = (0.8 * round).max(p.y - 0.56).max(0.055 - p.y);
    let thigh = bone(p, vec3(-0.035, 0.43, 0.015), vec3(-0.044, 0.28, 0.05), 0.034, 0.03);
    let shin = bone(p, vec3(-0.044, 0.28, 0.05), vec3(-0.05, 0.09, 0.052), 0.03, 0.032);
    join(wall, join(thigh, shin, 0.03), 0.05)
}

fn body(p: Vec3) -> f32 {
    let waist = bone(p, vec3(0.008, 0.52, 0.0), vec3(0.0, 0.6, 0.0), 0.056, 0.046);
    let chest = ellipsoid(p - vec3(0.0, 0.65, -0.002), vec3(0.064, 0.075, 0.047));
    let bust = |x: f32| (p - vec3(x, 0.652, 0.036)).length() - 0.023;
    let mut d = join(join(waist, chest, 0.05), bust(-0.028).min(bust(0.028)), 0.022);
    // The robe's upper part hangs in soft folds over a girdle.
    let angle = p.z.atan2(p.x);
    let soft = smooth_step(0.53, 0.56, p.y) * (1.0 - smooth_step(0.6, 0.68, p.y));
    d -= 0.0025 * soft * (13.0 * angle).cos();
    d = join(d, ring((p - vec3(0.003, 0.553, 0.0)) * vec3(1.0, 1.0, 1.08), 0.056, 0.0085), 0.006);
    let shoulders = bone(p, vec3(-0.062, 0.706, -0.004), vec3(0.064, 0.716, -0.004), 0.026, 0.026);
    d = join(d, shoulders, 0.035);
    d = join(d, bone(p, vec3(0.0, 0.71, -0.004), vec3(0.0, 0.785, 0.004), 0.025, 0.0205), 0.03);
    // Head and hair, which is gathered at the back.
    let head = ellipsoid(p - vec3(0.0, 0.832, 0.008), vec3(0.035, 0.047, 0.04));
    let chin = (p - vec3(0.0, 0.803, 0.022)).length() - 0.018;
    let nose = bone(p, vec3(0.0, 0.838, 0.046), vec3(0.0, 0.824, 0.0505), 0.0045, 0.006);
    let face = join(join(head, chin, 0.025), nose, 0.008);
    let brow = ellipsoid(p - vec3(0.0, 0.846, -0.004), vec3(0.041, 0.04, 0.044));
    let hair = join(brow, (p - vec3(0.0, 0.818, -0.043)).length() - 0.024, 0.015);
    let roll = ring(p - vec3(0.0, 0.882, 0.0), 0.024, 0.009);
    d = join(d, join(join(face, hair, 0.004), roll, 0.008), 0.014);
    // One arm steadies the jar, the other hand holds the robe.
    let arm = |shoulder: Vec3, elbow: Vec3, hand: Vec3| {
        let upper = bone(p, shoulder, elbow, 0.0245, 0.0185);
        let lower = bone(p, elbow, hand, 0.0185, 0.0125);
        join(upper, lower, 0.012)
    };
    let wrist = vec3(0.074, 0.915, 0.006);
    let raised = arm(vec3(0.068, 0.716, -0.004), vec3(0.142, 0.795, 0.008), wrist);
    let hand = bone(p, wrist, vec3(0.052, 0.948, 0.008), 0.013, 0.0095);
    let lowered = arm(vec3(-0.066, 0.704, -0.004), vec3(-0.108, 0.595, -0.012), vec3(-0.084, 0.5, 0.045));
    let fist = bone(p, vec3(-0.084, 0.5, 0.045), vec3(-0.07, 0.478, 0.056), 0.0155, 0.014);
    d = join(d, join(raised, hand, 0.012), 0.02);
    join(d, join(lowered, fist, 0.01), 0.016)
}
