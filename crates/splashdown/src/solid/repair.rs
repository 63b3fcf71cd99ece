//! Repairs meshes: welds vertices, removes degenerate and duplicate triangles, and orients faces outwards.

use std::collections::{HashMap, HashSet};
use std::fmt;

use glam::{IVec3, Vec3};
use splashdown_io::Mesh;

use super::bvh::{Bvh, solid_angle};
use super::openness::Openness;

/// The problems found in a mesh and the repairs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct RepairReport {
    /// Number of triangles given.
    pub triangles: u32,
    /// Vertices merged with another one.
    pub welded: u32,
    /// Removed triangles without area.
    pub degenerate: u32,
    /// Removed copies of triangles.
    pub duplicate: u32,
    /// Triangles whose orientation was reversed.
    pub flipped: u32,
    /// Edges of a single triangle: boundaries of holes and sheets.
    pub boundary_edges: u32,
    /// Edges of more than two triangles.
    pub non_manifold_edges: u32,
    /// Number of pieces connected by edges.
    pub pieces: u32,
    /// True if the mesh is treated as a sheet with a thickness rather than a solid.
    pub shell: bool,
    /// The estimated missing part of the surface in thousandths, if the mesh is open and `shell` was not given.
    pub missing: u32,
    /// Triangles of open fins of a solid, which are treated as sheets. They are the last ones of the repaired mesh.
    pub sheet_triangles: u32,
}

impl fmt::Display for RepairReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} triangles in {} pieces", self.triangles, self.pieces)?;
        for (count, what) in [
            (self.welded, "vertices welded"),
            (self.degenerate, "triangles without area removed"),
            (self.duplicate, "duplicate triangles removed"),
            (self.flipped, "triangles turned outwards"),
            (self.boundary_edges, "open edges"),
            (self.non_manifold_edges, "edges with more than two triangles"),
        ] {
            if count > 0 {
                write!(f, ", {count} {what}")?;
            }
        }
        if self.missing > 0 {
            write!(f, ", about {:.1} % missing", f64::from(self.missing) / 10.0)?;
        }
        f.write_str(if self.shell { "; treated as a shell" } else { "; treated as a solid" })?;
        match self.sheet_triangles {
            0 => Ok(()),
            count => write!(f, " with open fins ({count} triangles) as sheets"),
        }
    }
}

/// Vertices nearer to each other than this fraction of the mesh's diagonal are merged.
const WELD: f32 = 1e-6;

/// Repairs a mesh. `shell` overrides the decision between solid and shell.
pub fn repair(mesh: &Mesh, shell: Option<bool>) -> (Mesh, RepairReport) {
    let mut report = RepairReport { triangles: mesh.triangles.len() as u32, ..RepairReport::default() };
    let (vertices, indices) = weld(&mesh.vertices);
    report.welded = (mesh.vertices.len() - vertices.len()) as u32;
    let mut triangles = Vec::with_capacity(mesh.triangles.len());
    let mut seen = HashSet::new();
    for t in &mesh.triangles {
        let t = t.map(|v| indices[v as usize]);
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
    report.pieces = pieces.len() as u32;
    report.shell = shell.unwrap_or(false);
    if shell.is_none() && report.boundary_edges > 0 {
        let open = Openness::of(&vertices, &triangles, &pieces, &edges);
        report.shell = open.is_shell;
        triangles = open.fins_last(triangles);
        report.sheet_triangles = open.fins;
        report.missing = open.missing;
    }
    let (vertices, triangles) = compact(&vertices, &triangles);
    (Mesh::new(vertices, triangles), report)
}

/// The distinct positions, and the index of each vertex's position.
fn weld(given: &[[f32; 3]]) -> (Vec<Vec3>, Vec<u32>) {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for &v in given {
        (low, high) = (low.min(v.into()), high.max(v.into()));
    }
    let reach = (WELD * low.distance(high)).max(f32::MIN_POSITIVE);
    let mut cells: HashMap<IVec3, Vec<u32>> = HashMap::new();
    let mut positions: Vec<Vec3> = Vec::new();
    let mut indices = Vec::with_capacity(given.len());
    for &v in given {
        let v = Vec3::from(v);
        let at = (v - low) / (2.0 * reach);
        let cell = at.floor().as_ivec3();
        // Cells have edges of twice the reach, so only the eight cells on the nearer sides can have a
        // position in reach.
        let side = (at - at.floor()).map(|f| if f < 0.5 { -1.0 } else { 1.0 }).as_ivec3();
        let found = (0..8)
            .filter_map(|k| cells.get(&(cell + side * IVec3::new(k & 1, k >> 1 & 1, k >> 2))))
            .flatten()
            .copied()
            .find(|&p| positions[p as usize].distance_squared(v) <= reach * reach);
        indices.push(found.unwrap_or_else(|| {
            positions.push(v);
            let index = positions.len() as u32 - 1;
            cells.entry(cell).or_default().push(index);
            index
        }));
    }
    (positions, indices)
}

pub(super) type Edges = HashMap<[u32; 2], Vec<u32>>;

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

/// Orients neighbouring triangles consistently and pieces outwards. Returns the triangles of each piece.
fn orient(vertices: &[Vec3], triangles: &mut [[u32; 3]], edges: &Edges, flipped: &mut u32) -> Vec<Vec<u32>> {
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
                // Triangles of the same orientation traverse their common edge in opposite directions.
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
    pieces
}

/// Reverses pieces that face inwards, in order of decreasing area. A piece that encloses a volume is oriented
/// by the sign of that volume; a small open piece by the winding number of the larger pieces. A closed piece
/// that faces inwards inside a larger one is a cavity and keeps its orientation.
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
    // The tree is rebuilt only after many triangles have been added: a rebuild per small piece would take
    // minutes.
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
            let newer = placed[in_tree..].iter().map(|t| solid_angle(x, t)).sum::<f32>();
            tree.as_ref().map_or(0.0, |tree| tree.winding(x)) + newer / (4.0 * std::f32::consts::PI)
        };
        // The sign of the volume is meaningful only if the piece encloses one. A fragment of a surface does
        // not.
        let has_volume = size.abs() > 0.02 * areas[p].powf(1.5) / 10.0;
        let turn = if has_volume {
            let cavity = size < 0.0
                && rank > 0
                && piece
                    .iter()
                    .step_by(1 + piece.len() / 16)
                    .all(|&t| winding(corner(triangles[t as usize][0])) > 0.5);
            size < 0.0 && !cavity
        } else if rank > 0 && rank < 2000 {
            // The fragment fills a gap in the surface: the winding number of the larger pieces is lower on
            // its outside.
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
        // Pieces beyond the first few hundred hardly change the winding number.
        if rank < 300 {
            placed.extend(piece.iter().map(|&t| triangles[t as usize].map(corner)));
        }
    }
}

/// Removes vertices that no triangle uses.
fn compact(vertices: &[Vec3], triangles: &[[u32; 3]]) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let mut indices = vec![u32::MAX; vertices.len()];
    let mut kept = Vec::new();
    let triangles = triangles
        .iter()
        .map(|t| {
            t.map(|v| {
                let index = &mut indices[v as usize];
                if *index == u32::MAX {
                    *index = kept.len() as u32;
                    kept.push(vertices[v as usize].to_array());
                }
                *index
            })
        })
        .collect();
    (kept, triangles)
}
