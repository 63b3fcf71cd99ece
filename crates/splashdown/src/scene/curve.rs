//! Cubic Hermite curves.

/// The weights of the start, of the slope there, of the end and of the slope there at a part `f` (0 to 1) of the way. Slopes
/// are those per whole way.
///
/// ```
/// // From 2 at rest to 4 at rest.
/// let [start, _, end, _] = splashdown::scene::hermite_weights(0.5);
/// assert_eq!(2.0 * start + 4.0 * end, 3.0);
/// ```
pub fn hermite_weights(f: f64) -> [f64; 4] {
    let (f2, f3) = (f * f, f * f * f);
    [2.0 * f3 - 3.0 * f2 + 1.0, f3 - 2.0 * f2 + f, 3.0 * f2 - 2.0 * f3, f3 - f2]
}
