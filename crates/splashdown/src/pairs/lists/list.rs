//! The neighbours of some particles, four at a time, and sums over them.

use glam::Vec4;

use crate::pairs::near::{Formula, Link, NearImages};
use crate::pairs::particles::Outputs;
use crate::pairs::vectors::{Quad, QuadLeaf};

/// The neighbours of the particles in some rows of cells.
#[derive(Default)]
pub(super) struct List {
    /// For each group of four particles, the end of their neighbours.
    ends: Vec<usize>,
    /// A neighbour of each particle of a group, side by side. Where a particle has fewer than the others, links with a
    /// factor of zero follow.
    neighbours: Vec<[Link; 4]>,
    /// The neighbours of the particles of a group that is not complete.
    open: [Vec<Link>; 4],
    /// For each particle, the end of its images.
    image_ends: Vec<usize>,
    /// The vector of each image, and the bits of its index and its reflection as the fourth component.
    images: Vec<Vec4>,
}

impl List {
    pub fn clear(&mut self) {
        self.ends.clear();
        self.neighbours.clear();
        self.open.iter_mut().for_each(Vec::clear);
        self.image_ends.clear();
        self.images.clear();
    }

    /// The number of particles.
    pub fn len(&self) -> usize {
        self.image_ends.len()
    }

    /// The neighbours of the next particle, which [`end_particle`](Self::end_particle) ends.
    #[inline(always)]
    pub fn neighbours(&mut self) -> &mut Vec<Link> {
        &mut self.open[self.image_ends.len() % 4]
    }

    /// Its images.
    #[inline(always)]
    pub fn images(&mut self) -> &mut Vec<Vec4> {
        &mut self.images
    }

    /// Ends the neighbours of a particle. `first` is the index of the first particle of the list.
    #[inline(always)]
    pub fn end_particle(&mut self, first: usize) {
        self.image_ends.push(self.images.len());
        if self.len().is_multiple_of(4) {
            self.close_group(first);
        }
    }

    /// Ends the list.
    #[inline(always)]
    pub fn end(&mut self, first: usize) {
        if !self.len().is_multiple_of(4) {
            self.close_group(first);
        }
    }

    /// Appends the neighbours of the particles of the open group.
    #[inline(always)]
    fn close_group(&mut self, first: usize) {
        let last = first + self.len() - 1;
        let first_in_group = first + 4 * self.ends.len();
        let longest = self.open.iter().map(Vec::len).max().unwrap_or(0);
        for (k, links) in self.open.iter_mut().enumerate() {
            // The particle itself: what is not finite stays with it. The sums of places without a particle are not used.
            links.resize(longest, Link::none((first_in_group + k).min(last)));
        }
        let [a, b, c, d] = &self.open;
        let rows = a.iter().zip(b).zip(c).zip(d).map(|(((a, b), c), d)| [*a, *b, *c, *d]);
        self.neighbours.extend(rows);
        self.ends.push(self.neighbours.len());
        self.open.iter_mut().for_each(Vec::clear);
    }

    /// The neighbours of each particle.
    #[cfg(test)]
    pub fn indices(&self) -> impl Iterator<Item = Vec<usize>> {
        (0..self.len()).map(|k| {
            let begin = if k < 4 { 0 } else { self.ends[k / 4 - 1] };
            let links = self.neighbours[begin..self.ends[k / 4]].iter().map(|links| links[k % 4]);
            links.filter(|link| link.factor != 0.0).map(|link| link.index()).collect()
        })
    }
}

/// Computes the results of the particles of a list.
pub(super) struct Visit<'a, O, F, R> {
    list: &'a List,
    first: usize,
    outputs: O,
    formula: &'a F,
    result: &'a R,
}

impl<'a, O, F: Formula, R> Visit<'a, O, F, R> {
    /// `first` is the first particle.
    ///
    /// # Safety
    /// All indices of the list must be below the number of vectors of the formula.
    pub unsafe fn new(list: &'a List, first: usize, outputs: O, formula: &'a F, result: &'a R) -> Self {
        Self { list, first, outputs, formula, result }
    }
}

impl<T, O: Outputs<T>, F: Formula, R: Fn(usize, Vec4, NearImages<'_>) -> T> QuadLeaf for Visit<'_, O, F, R> {
    #[inline(always)]
    fn run<Q: Quad>(self) {
        let Self { list, first, mut outputs, formula, result } = self;
        let (mut begin, mut begin_images) = (0, 0);
        for (group, &end) in list.ends.iter().enumerate() {
            let own = formula.own::<Q>(first + 4 * group);
            let mut sum = Q::splat(Vec4::ZERO);
            for links in &list.neighbours[begin..end] {
                // SAFETY: all indices are below the number of vectors, as the caller of `new` guarantees.
                sum = sum + unsafe { formula.of(own, links) };
            }
            begin = end;
            let image_ends = &list.image_ends[4 * group..];
            for (k, (sum, &end)) in sum.parts().into_iter().zip(image_ends).enumerate() {
                let near_images = NearImages::new(&list.images[begin_images..end]);
                outputs.put(4 * group + k, result(first + 4 * group + k, sum, near_images));
                begin_images = end;
            }
        }
    }
}
