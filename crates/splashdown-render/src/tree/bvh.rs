//! A tree of boxes over triangles (bounding volume hierarchy), built on the host.
//!
//! Top-down, with the split of each node chosen among equal slices of the longest axis by the
//! surface area heuristic (Wald, "On fast construction of SAH-based bounding volume hierarchies",
//! 2007). Below [`MEDIAN_DEPTH`] a node is split at its median, which bounds the depth and with it
//! the stack of the traversal.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// Largest number of triangles in a leaf.
const LEAF: usize = 4;
/// Slices among which a split is chosen.
const SLICES: usize = 12;
/// From this depth on, nodes are split at the median.
const MEDIAN_DEPTH: u32 = 18;
/// Entries of the stack in `trace.wgsl`. A median split halves the triangles, of which there are
/// fewer than 2^28.
#[cfg(test)]
const STACK: u32 = 48;
/// Marks a child that is a leaf. The 28 low bits are the first triangle, the three above them the
/// number of triangles.
const IS_LEAF: u32 = 1 << 31;
/// Largest number of triangles.
pub(super) const MAX_TRIANGLES: usize = 1 << 28;

/// A node: the boxes of its two children. Mirrors the four rows that `trace.wgsl` reads.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Node {
    pub children: [Child; 2],
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Child {
    pub low: [f32; 3],
    /// A node, or a leaf with its triangles.
    pub content: u32,
    pub high: [f32; 3],
    pub unused: u32,
}

impl Node {
    /// The node in a buffer where the nodes and triangles of its tree begin at these indices.
    pub fn moved(mut self, first_node: u32, first_triangle: u32) -> Node {
        for child in &mut self.children {
            child.content += if child.content & IS_LEAF == 0 { first_node } else { first_triangle };
        }
        self
    }
}

impl Child {
    /// A box that no ray hits.
    const EMPTY: Child = Child { low: [f32::MAX; 3], content: IS_LEAF, high: [f32::MIN; 3], unused: 0 };

    fn new(bounds: Bounds, content: u32) -> Child {
        Child { low: bounds.low.into(), content, high: bounds.high.into(), unused: 0 }
    }
}

#[derive(Clone, Copy, Debug)]
struct Bounds {
    low: Vec3,
    high: Vec3,
}

impl Bounds {
    const EMPTY: Bounds = Bounds { low: Vec3::MAX, high: Vec3::MIN };

    fn add(&mut self, other: Bounds) {
        self.low = self.low.min(other.low);
        self.high = self.high.max(other.high);
    }

    /// Half the surface area; zero if empty.
    fn area(&self) -> f32 {
        let size = (self.high - self.low).max(Vec3::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// A triangle while the tree is built.
#[derive(Clone, Copy, Debug)]
struct Item {
    bounds: Bounds,
    centre: Vec3,
    index: u32,
}

/// Nodes, of which the first is the root, and the order of the triangles in the leaves.
pub(super) fn build(triangles: impl Iterator<Item = [Vec3; 3]>) -> (Vec<Node>, Vec<u32>) {
    let mut items: Vec<Item> = triangles
        .enumerate()
        .map(|(index, [a, b, c])| {
            let bounds = Bounds { low: a.min(b).min(c), high: a.max(b).max(c) };
            Item { bounds, centre: 0.5 * (bounds.low + bounds.high), index: index as u32 }
        })
        .collect();
    let mut nodes = vec![Node { children: [Child::EMPTY; 2] }];
    if items.len() <= LEAF {
        if !items.is_empty() {
            let bounds = bounds_of(&items);
            nodes[0].children[0] = Child::new(bounds, leaf(0, items.len()));
        }
    } else {
        fill(&mut nodes, &mut items);
    }
    (nodes, items.iter().map(|item| item.index).collect())
}

fn leaf(first: usize, count: usize) -> u32 {
    IS_LEAF | (count as u32) << 28 | first as u32
}

/// Splits nodes until their items fit into leaves.
fn fill(nodes: &mut Vec<Node>, items: &mut [Item]) {
    // Node, first item, end, depth.
    let mut pending = vec![(0, 0, items.len(), 0)];
    while let Some((node, first, end, depth)) = pending.pop() {
        let middle = first + split(&mut items[first..end], depth);
        for (side, (from, to)) in [(first, middle), (middle, end)].into_iter().enumerate() {
            let bounds = bounds_of(&items[from..to]);
            let content = if to - from <= LEAF {
                leaf(from, to - from)
            } else {
                nodes.push(Node { children: [Child::EMPTY; 2] });
                pending.push((nodes.len() - 1, from, to, depth + 1));
                nodes.len() as u32 - 1
            };
            nodes[node].children[side] = Child::new(bounds, content);
        }
    }
}

/// Orders the items of a node and returns how many belong to its first child, at least one of each.
fn split(items: &mut [Item], depth: u32) -> usize {
    let centres = items.iter().fold(Bounds::EMPTY, |sum, item| Bounds {
        low: sum.low.min(item.centre),
        high: sum.high.max(item.centre),
    });
    let size = centres.high - centres.low;
    let axis = size.max_position();
    if depth < MEDIAN_DEPTH && size[axis] > 0.0 {
        let scale = SLICES as f32 / size[axis];
        let slice_of =
            |item: &Item| (((item.centre[axis] - centres.low[axis]) * scale) as usize).min(SLICES - 1);
        let cut = cheapest_cut(items, slice_of);
        let mut middle = 0;
        for i in 0..items.len() {
            if slice_of(&items[i]) < cut {
                items.swap(i, middle);
                middle += 1;
            }
        }
        if middle > 0 && middle < items.len() {
            return middle;
        }
    }
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| a.centre[axis].total_cmp(&b.centre[axis]));
    middle
}

/// The first slice of the second child in the split with the lowest expected cost.
fn cheapest_cut(items: &[Item], slice_of: impl Fn(&Item) -> usize) -> usize {
    let mut slices = [(Bounds::EMPTY, 0_usize); SLICES];
    for item in items {
        let (bounds, count) = &mut slices[slice_of(item)];
        bounds.add(item.bounds);
        *count += 1;
    }
    let cost = |(bounds, count): (Bounds, usize)| bounds.area() * count as f32;
    let join = |mut sum: (Bounds, usize), slice: &(Bounds, usize)| {
        sum.0.add(slice.0);
        (sum.0, sum.1 + slice.1)
    };
    let mut above = [0.0; SLICES];
    let mut sum = (Bounds::EMPTY, 0);
    for i in (1..SLICES).rev() {
        sum = join(sum, &slices[i]);
        above[i] = cost(sum);
    }
    let mut best = (f32::MAX, SLICES / 2);
    let mut sum = (Bounds::EMPTY, 0);
    for i in 1..SLICES {
        sum = join(sum, &slices[i - 1]);
        let total = cost(sum) + above[i];
        if sum.1 > 0 && total < best.0 {
            best = (total, i);
        }
    }
    best.1
}

fn bounds_of(items: &[Item]) -> Bounds {
    let mut sum = Bounds::EMPTY;
    items.iter().for_each(|item| sum.add(item.bounds));
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Triangles at reproducible places.
    fn cloud(count: usize) -> Vec<[Vec3; 3]> {
        let mut state = 1_u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 24) as f32
        };
        (0..count)
            .map(|_| {
                let centre = Vec3::new(next(), next(), next());
                [0; 3].map(|_| centre + 0.05 * Vec3::new(next(), next(), next()))
            })
            .collect()
    }

    /// Depth of the tree, after checking that every triangle is in one leaf and inside all boxes above it.
    fn check(nodes: &[Node], order: &[u32], triangles: &[[Vec3; 3]]) -> u32 {
        let mut seen = vec![false; triangles.len()];
        let mut deepest = 0;
        let mut pending = vec![(0, Vec3::MIN, Vec3::MAX, 1)];
        while let Some((node, low, high, depth)) = pending.pop() {
            deepest = deepest.max(depth);
            let node: &Node = &nodes[node];
            for child in node.children {
                let (inner_low, inner_high) = (Vec3::from(child.low), Vec3::from(child.high));
                if child.content & IS_LEAF == 0 {
                    assert!(inner_low.cmpge(low).all() && inner_high.cmple(high).all());
                    pending.push((child.content as usize, inner_low, inner_high, depth + 1));
                    continue;
                }
                let first = (child.content & 0xfff_ffff) as usize;
                for &index in &order[first..first + (child.content >> 28 & 7) as usize] {
                    assert!(!std::mem::replace(&mut seen[index as usize], true));
                    for corner in triangles[index as usize] {
                        assert!(corner.cmpge(inner_low).all() && corner.cmple(inner_high).all());
                    }
                }
            }
        }
        assert!(seen.iter().all(|&seen| seen));
        deepest
    }

    #[test]
    fn every_triangle_is_in_one_leaf_and_inside_its_boxes() {
        for count in [0, 1, 4, 5, 9, 1000, 20_000] {
            let triangles = cloud(count);
            let (nodes, order) = build(triangles.iter().copied());
            assert!(check(&nodes, &order, &triangles) < STACK);
        }
        // All at one place: only the median bounds the depth.
        let same = vec![[Vec3::ZERO, Vec3::X, Vec3::Y]; 5000];
        let (nodes, order) = build(same.iter().copied());
        assert!(check(&nodes, &order, &same) < STACK);
    }

    #[test]
    fn splits_by_area_cost_less_than_splits_at_the_median() {
        // Two distant groups of very different size.
        let mut triangles = cloud(4000);
        triangles.extend(cloud(40).into_iter().map(|t| t.map(|corner| corner + 20.0 * Vec3::X)));
        let cost = |nodes: &[Node]| -> f32 {
            let area = |child: &Child| Bounds { low: child.low.into(), high: child.high.into() }.area();
            nodes.iter().flat_map(|node| &node.children).map(area).sum()
        };
        let (nodes, _) = build(triangles.iter().copied());
        // Negative control: only median splits.
        let mut items: Vec<Item> = Vec::new();
        for (index, &[a, b, c]) in triangles.iter().enumerate() {
            let bounds = Bounds { low: a.min(b).min(c), high: a.max(b).max(c) };
            items.push(Item { bounds, centre: 0.5 * (bounds.low + bounds.high), index: index as u32 });
        }
        let mut medians = vec![Node { children: [Child::EMPTY; 2] }];
        let mut pending = vec![(0, 0, items.len())];
        while let Some((node, first, end)) = pending.pop() {
            let middle = first + split(&mut items[first..end], MEDIAN_DEPTH);
            for (side, (from, to)) in [(first, middle), (middle, end)].into_iter().enumerate() {
                let content = if to - from <= LEAF {
                    leaf(from, to - from)
                } else {
                    medians.push(Node { children: [Child::EMPTY; 2] });
                    pending.push((medians.len() - 1, from, to));
                    medians.len() as u32 - 1
                };
                medians[node].children[side] = Child::new(bounds_of(&items[from..to]), content);
            }
        }
        assert!(cost(&nodes) < cost(&medians), "{} {}", cost(&nodes), cost(&medians));
    }
}
