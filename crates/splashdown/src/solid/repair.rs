//! Mends meshes as they are found: welds, drops what has no area or is there twice, and turns faces outwards.

use std::collections::{HashMap, HashSet};
use std::fmt;

use glam::{DVec3, IVec3, Vec3};
use splashdown_io::Mesh;

use super::bvh::{Bvh, solid_angle};

/// What was found in a mesh, and what was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct RepairReport {
    /// Triangles given.
    pub triangles: u32,
    /// Vertices that were joined with another.
    pub welded: u32,
    /// Triangles without area, dropped.
    pub degenerate: u32,
    /// Triangles that were there twice, dropped.
    pub duplicate: u32,
    /// Triangles turned round.
    pub flipped: u32,
    /// Edges of one triangle only: rims of holes and sheets.
    pub boundary_edges: u32,
    /// Edges of more than two triangles.
    pub non_manifold_edges: u32,
    /// Pieces that hang together by edges.
    pub pieces: u32,
    /// True if it is taken for a sheet with a thickness rather than a solid.
    pub shell: bool,
}

impl fmt::Display for RepairReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} triangles in {} pieces", self.triangles, self.pieces)?;
        for (count, what) in [
            (self.welded, "vertices welded"),
            (self.degenerate, "triangles without area dropped"),
            (self.duplicate, "duplicate triangles dropped"),
            (self.flipped, "triangles turned outwards"),
            (self.boundary_edges, "open edges"),
            (self.non_manifold_edges, "edges with more than two triangles"),
        ] {
            if count > 0 {
                write!(f, ", {count} {what}")?;
            }
        }
        f.write_str(if self.shell { "; taken as a shell" } else { "; taken as a solid" })
    }
}

/// Vertices nearer than this part of the mesh's diagonal are one.
const WELD: f32 = 1e-6;
/// Holes of more than this part of the whole area make a shell of a mesh.
const OPEN: f64 = 0.08;

/// Mends a mesh; `shell` overrides what it is taken for.
pub fn repair(mesh: &Mesh, shell: Option<bool>) -> (Mesh, RepairReport) {
    let mut report = RepairReport { triangles: mesh.triangles.len() as u32, ..RepairReport::default() };
    let (vertices, names) = weld(&mesh.vertices);
    report.welded = (mesh.vertices.len() - vertices.len()) as u32;
    let mut triangles = Vec::with_capacity(mesh.triangles.len());
    let mut seen = HashSet::new();
    for t in &mesh.triangles {
        let t = t.map(|v| names[v as usize]);
        let [a, b, c] = t.map(|v| vertices[v as usize]);
        let cross = (b - a).cross(c - a).length();
        let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
        let mut key = t;
        key.sort_unstable();
        if key[0] == key[1] || key[1] == key[2] || cross <= 1e-7 * longest {
            report.degenerate += 1;
        } else if !seen.insert(key) {
            report.duplicate += 1;
        } else {
            triangles.push(t);
        }
    }
    let edges = edges_of(&triangles);
    report.boundary_edges = edges.values().filter(|list| list.len() == 1).count() as u32;
    report.non_manifold_edges = edges.values().filter(|list| list.len() > 2).count() as u32;
    let pieces = orient(&vertices, &mut triangles, &edges, &mut report.flipped);
    report.pieces = pieces;
    report.shell = shell.unwrap_or_else(|| open_part(&vertices, &triangles) > OPEN);
    let (vertices, triangles) = compact(&vertices, &triangles);
    (Mesh::new(vertices, triangles), report)
}

/// Distinct places, and the number of each vertex among them.
fn weld(given: &[[f32; 3]]) -> (Vec<Vec3>, Vec<u32>) {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for &v in given {
        (low, high) = (low.min(v.into()), high.max(v.into()));
    }
    let reach = (WELD * low.distance(high)).max(f32::MIN_POSITIVE);
    let mut cells: HashMap<IVec3, Vec<u32>> = HashMap::new();
    let mut places: Vec<Vec3> = Vec::new();
    let mut names = Vec::with_capacity(given.len());
    for &v in given {
        let v = Vec3::from(v);
        let at = (v - low) / (2.0 * reach);
        let home = at.floor().as_ivec3();
        // Only the cells on the near side can hold a place within reach.
        let side = (at - at.floor()).map(|f| if f < 0.5 { -1.0 } else { 1.0 }).as_ivec3();
        let found = (0..8)
            .filter_map(|k| cells.get(&(home + side * IVec3::new(k & 1, k >> 1 & 1, k >> 2))))
            .flatten()
            .copied()
            .find(|&p| places[p as usize].distance_squared(v) <= reach * reach);
        names.push(found.unwrap_or_else(|| {
            places.push(v);
            let name = places.len() as u32 - 1;
            cells.entry(home).or_default().push(name);
            name
        }));
    }
    (places, names)
}

type Edges = HashMap<[u32; 2], Vec<u32>>;

fn edges_of(triangles: &[[u32; 3]]) -> Edges {
    let mut edges: Edges = HashMap::new();
    for (t, triangle) in triangles.iter().enumerate() {
        for k in 0..3 {
            let [a, b] = [triangle[k], triangle[(k + 1) % 3]];
            edges.entry([a.min(b), a.max(b)]).or_default().push(t as u32);
        }
    }
    edges
}

/// Makes neighbours agree and pieces face outwards; the number of pieces.
fn orient(vertices: &[Vec3], triangles: &mut [[u32; 3]], edges: &Edges, flipped: &mut u32) -> u32 {
    let mut piece_of = vec![u32::MAX; triangles.len()];
    let mut pieces: Vec<Vec<u32>> = Vec::new();
    let mut turned = vec![false; triangles.len()];
    for start in 0..triangles.len() as u32 {
        if piece_of[start as usize] != u32::MAX {
            continue;
        }
        let piece = pieces.len() as u32;
        piece_of[start as usize] = piece;
        let mut members = vec![start];
        let mut next = 0;
        while next < members.len() {
            let t = members[next];
            next += 1;
            for k in 0..3 {
                let tri = triangles[t as usize];
                let [a, b] = [tri[k], tri[(k + 1) % 3]];
                let sharing = &edges[&[a.min(b), a.max(b)]];
                let &[one, two] = sharing.as_slice() else { continue };
                let other = if one == t { two } else { one };
                if piece_of[other as usize] != u32::MAX {
                    continue;
                }
                let neighbour = &mut triangles[other as usize];
                // Neighbours that agree run along their edge in opposite directions.
                let same = (0..3).any(|j| neighbour[j] == a && neighbour[(j + 1) % 3] == b);
                if same {
                    neighbour.swap(1, 2);
                    turned[other as usize] = true;
                }
                piece_of[other as usize] = piece;
                members.push(other);
            }
        }
        pieces.push(members);
    }
    face_outwards(vertices, triangles, &pieces, &mut turned);
    *flipped = turned.iter().filter(|&&t| t).count() as u32;
    pieces.len() as u32
}

/// Turns pieces whose outside is not outside: the largest by its volume, then the others by what the winding
/// number of all larger ones says about them. Closed pieces inside others that face inwards are hollows and
/// stay.
fn face_outwards(vertices: &[Vec3], triangles: &mut [[u32; 3]], pieces: &[Vec<u32>], turned: &mut [bool]) {
    let corner = |v: u32| vertices[v as usize];
    let volume = |triangles: &[[u32; 3]], piece: &[u32]| -> f64 {
        let origin = corner(triangles[piece[0] as usize][0]);
        piece
            .iter()
            .map(|&t| {
                let [a, b, c] = triangles[t as usize].map(|v| (corner(v) - origin).as_dvec3());
                a.dot(b.cross(c)) / 6.0
            })
            .sum()
    };
    let area = |triangles: &[[u32; 3]], piece: &[u32]| -> f64 {
        piece
            .iter()
            .map(|&t| {
                let [a, b, c] = triangles[t as usize].map(corner);
                0.5 * f64::from((b - a).cross(c - a).length())
            })
            .sum()
    };
    let mut order: Vec<usize> = (0..pieces.len()).collect();
    let areas: Vec<f64> = pieces.iter().map(|piece| area(triangles, piece)).collect();
    order.sort_by(|&a, &b| areas[b].total_cmp(&areas[a]));
    let mut placed: Vec<[Vec3; 3]> = Vec::new();
    // Built again only after a good part has been added: a tree per scrap would take minutes.
    let mut tree: Option<Bvh> = None;
    let mut in_tree = 0;
    for (rank, &p) in order.iter().enumerate() {
        let piece = &pieces[p];
        let size = volume(triangles, piece);
        if placed.len() > in_tree + in_tree / 16 {
            in_tree = placed.len();
            tree = Some(Bvh::new(placed.clone()));
        }
        let winding = |x: Vec3| {
            let late = placed[in_tree..].iter().map(|t| solid_angle(x, t)).sum::<f32>();
            tree.as_ref().map_or(0.0, |tree| tree.winding(x)) + late / (4.0 * std::f32::consts::PI)
        };
        // A piece with a volume of its own says where its inside is; a scrap of a torn surface does not.
        let own_way = size.abs() > 0.02 * areas[p].powf(1.5) / 10.0;
        let turn = if own_way {
            let hollow = size < 0.0
                && rank > 0
                && piece
                    .iter()
                    .step_by(1 + piece.len() / 16)
                    .all(|&t| winding(corner(triangles[t as usize][0])) > 0.5);
            size < 0.0 && !hollow
        } else if rank > 0 && rank < 2000 {
            // The face belongs where the surface is missing: its outside is where the others' winding number is lower.
            let votes: f32 = piece
                .iter()
                .step_by(1 + piece.len() / 8)
                .map(|&t| {
                    let [a, b, c] = triangles[t as usize].map(corner);
                    let normal = (b - a).cross(c - a);
                    let step = 0.3 * normal.length().sqrt() * normal.normalize_or_zero();
                    let middle = (a + b + c) / 3.0;
                    winding(middle - step) - winding(middle + step)
                })
                .sum();
            votes < 0.0
        } else {
            size < 0.0
        };
        if turn {
            for &t in piece {
                triangles[t as usize].swap(1, 2);
                turned[t as usize] = !turned[t as usize];
            }
        }
        // Scraps beyond the first few hundred change nothing about where the inside is.
        if rank < 300 {
            placed.extend(piece.iter().map(|&t| triangles[t as usize].map(corner)));
        }
    }
}

/// The area of the holes as a part of the whole area: of each closed line of open edges its vector area.
fn open_part(vertices: &[Vec3], triangles: &[[u32; 3]]) -> f64 {
    let place = |v: u32| vertices[v as usize].as_dvec3();
    let mut area = 0.0;
    let mut open: HashMap<u32, Vec<u32>> = HashMap::new();
    let edges = edges_of(triangles);
    for t in triangles {
        let [a, b, c] = t.map(place);
        area += 0.5 * (b - a).cross(c - a).length();
        for k in 0..3 {
            let [a, b] = [t[k], t[(k + 1) % 3]];
            if edges[&[a.min(b), a.max(b)]].len() == 1 {
                open.entry(a).or_default().push(b);
                open.entry(b).or_default();
            }
        }
    }
    let mut done = HashSet::new();
    let mut holes = 0.0;
    let mut starts: Vec<u32> = open.keys().copied().collect();
    starts.sort_unstable();
    for start in starts {
        // All open edges that hang together are one hole.
        let mut stack = vec![start];
        let (mut hole, origin) = (DVec3::ZERO, place(start));
        while let Some(a) = stack.pop() {
            if !done.insert(a) {
                continue;
            }
            for &b in &open[&a] {
                hole += 0.5 * (place(a) - origin).cross(place(b) - origin);
                stack.push(b);
            }
        }
        holes += hole.length();
    }
    if area > 0.0 { holes / area } else { 0.0 }
}

/// Drops vertices that no triangle uses.
fn compact(vertices: &[Vec3], triangles: &[[u32; 3]]) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let mut names = vec![u32::MAX; vertices.len()];
    let mut kept = Vec::new();
    let triangles = triangles
        .iter()
        .map(|t| {
            t.map(|v| {
                let name = &mut names[v as usize];
                if *name == u32::MAX {
                    *name = kept.len() as u32;
                    kept.push(vertices[v as usize].to_array());
                }
                *name
            })
        })
        .collect();
    (kept, triangles)
}
