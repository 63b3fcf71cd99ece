//! Emitters and sinks that work against one another.

use glam::Vec3;

use super::{LoadedFlow, Nozzle};

/// An emitter whose columns are removed to more than this part counts as removed.
const MOST_REMOVED: f32 = 0.5;
/// Places along the axis of a nozzle that are tested, from its back face to its outlet.
const PLACES: u32 = 9;

impl LoadedFlow {
    /// Pairs of an emitter and a sink that removes most of its particles before they leave the nozzle.
    pub(crate) fn swallowed(&self) -> Vec<[usize; 2]> {
        let drains = || self.drains.iter().enumerate();
        let pairs = self.nozzles.iter().enumerate().flat_map(|(k, nozzle)| {
            drains().filter_map(move |(sink, drain)| {
                let removed = |column: &[Vec3]| column.iter().any(|&x| drain.takes(&self.maps, x));
                (self.share(nozzle, removed) > MOST_REMOVED).then_some([k, sink])
            })
        });
        pairs.collect()
    }

    /// Pairs of emitters that emit at the same time and whose nozzles cross.
    pub(crate) fn crossing(&self) -> Vec<[usize; 2]> {
        let nozzles = || self.nozzles.iter().enumerate();
        let pairs = nozzles().flat_map(|(i, first)| {
            nozzles().skip(i + 1).filter_map(move |(j, second)| {
                let inside = |other: &Nozzle, column: &[Vec3]| column.iter().any(|&x| other.holds(x, 0.0));
                let is_simultaneous = first.start.max(second.start) < first.end.min(second.end);
                let crosses = self.share(first, |column| inside(second, column)) > 0.0
                    || self.share(second, |column| inside(first, column)) > 0.0;
                (is_simultaneous && crosses).then_some([i, j])
            })
        });
        pairs.collect()
    }

    /// Whether a sink removes particles at this place.
    pub(crate) fn removes(&self, x: Vec3) -> bool {
        self.drains.iter().any(|drain| drain.takes(&self.maps, x))
    }

    /// The length of an emitter's nozzle in m.
    pub(crate) fn nozzle_length(&self, emitter: usize) -> f32 {
        self.nozzles[emitter].length
    }

    /// The length of the longest nozzle in m.
    pub(crate) fn longest_nozzle(&self) -> f32 {
        self.nozzles.iter().map(|nozzle| nozzle.length).fold(0.0, f32::max)
    }

    /// The part of a nozzle's columns for which `test` holds.
    fn share(&self, nozzle: &Nozzle, test: impl Fn(&[Vec3]) -> bool) -> f32 {
        let points = &self.points[nozzle.first_point as usize..][..nozzle.points as usize];
        let count = points.iter().filter(|q| {
            let place = |k: u32| {
                let along = nozzle.length * k as f32 / (PLACES - 1) as f32;
                nozzle.back + along * nozzle.direction + q.x * nozzle.across + q.y * nozzle.up
            };
            test(&(0..PLACES).map(place).collect::<Vec<_>>())
        });
        count.count() as f32 / points.len().max(1) as f32
    }
}
