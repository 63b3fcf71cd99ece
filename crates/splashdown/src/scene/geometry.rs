//! Checks the sizes of the domain and of the blocks: against each other, against the maximum number of
//! particles, and against the precision of f32.

use super::lattice::{self, MAX_PARTICLES, Sampler};
use super::reader::{Read, Reported, Section};
use super::spec::rounded;
use super::types::{Block, Domain, Fluid, InitialPressure, Material};

/// Maximum distance from the origin in spacings. Coordinates in f32 are accurate to half a per cent of a
/// spacing there.
const MAX_SPACINGS: f32 = 100_000.0;
/// Maximum number of cells of the neighbour grid, which covers the whole domain with edges of two spacings.
const MAX_CELLS: f64 = (1u64 << 26) as f64;
/// Minimum edge length of the domain in spacings.
const MIN_SPACINGS: f32 = 4.0;
/// Tolerance, in spacings, for a block that reaches out of the domain. It covers the rounding of positions.
const SLACK: f32 = 0.02;

/// A block, if it could be read, and its section.
pub(crate) type ReadBlock<'r> = (Result<Block, Reported>, Section<'r>);

/// Checks all values that could be read; `Err` if there is a problem.
pub(crate) fn check(
    domain_section: &Result<Section<'_>, Reported>,
    domain: Option<&Domain>,
    fluid_section: &Section<'_>,
    spacing: Read<f32>,
    blocks: &Result<Vec<ReadBlock<'_>>, Reported>,
) -> Result<(), Reported> {
    let (Ok(Some(spacing)), Ok(domain_section), Some(domain)) = (spacing, domain_section, domain) else {
        return Err(Reported);
    };
    let mut result = check_domain(domain_section, domain, fluid_section, spacing);
    let Ok(blocks) = blocks else { return Err(Reported) };
    for (block, section) in blocks {
        let fits =
            block.as_ref().map_err(|r| *r).and_then(|block| check_block(section, block, domain, spacing));
        result = result.and(fits);
    }
    let whole: Vec<Block> = blocks.iter().filter_map(|(block, _)| block.as_ref().ok().cloned()).collect();
    let fluid = Fluid {
        particle_spacing: spacing,
        material: Material::water(),
        blocks: whole,
        meshes: Vec::new(),
        files: Vec::new(),
        initial_pressure: InitialPressure::Zero,
    };
    let count = lattice::estimate(&fluid);
    if count > MAX_PARTICLES {
        let fitting = rounded(lattice::fitting_spacing(spacing, count, MAX_PARTICLES));
        let message = format!("fluid.particle_spacing = {spacing} m gives {} particles", grouped(count));
        let allowed = format!("at most {} particles", grouped(MAX_PARTICLES));
        let hint = format!("a spacing of {fitting} m or more fits, or make the blocks smaller");
        return Err(fluid_section.complain("particle_spacing", message, &allowed, &hint));
    }
    result?;
    report_overlaps(domain, &fluid, blocks);
    Ok(())
}

fn check_domain(
    section: &Section<'_>,
    domain: &Domain,
    fluid: &Section<'_>,
    spacing: f32,
) -> Result<(), Reported> {
    let size = domain.size();
    if size.min_element() < MIN_SPACINGS * spacing {
        let message = format!(
            "the domain is {} x {} x {} m: too thin for a particle spacing of {spacing} m",
            size.x, size.y, size.z
        );
        let allowed = format!("edges of at least {} m", rounded(MIN_SPACINGS * spacing));
        return Err(section.complain(
            "max",
            message,
            &allowed,
            "enlarge the domain or refine fluid.particle_spacing",
        ));
    }
    let farthest = domain.min.abs().max(domain.max.abs()).max_element();
    if farthest > MAX_SPACINGS * spacing {
        let message = format!(
            "the domain reaches {farthest} m from the origin: single precision cannot place particles {spacing} m apart there"
        );
        let allowed = format!("at most {} m with this spacing", rounded(MAX_SPACINGS * spacing));
        return Err(section.complain(
            "max",
            message,
            &allowed,
            "move the domain to the origin, or enlarge fluid.particle_spacing",
        ));
    }
    let cells: f64 =
        size.to_array().iter().map(|edge| (f64::from(*edge) / (2.0 * f64::from(spacing))).ceil()).product();
    if cells > MAX_CELLS {
        let message = format!(
            "fluid.particle_spacing = {spacing} m divides the domain into {} cells",
            grouped(cells as u64)
        );
        let fitting = f64::from(spacing) * (cells / MAX_CELLS).cbrt();
        let hint = format!(
            "shrink the domain to the region that the fluid needs, or use a spacing of about {} m",
            rounded((fitting * 1.01) as f32)
        );
        return Err(fluid.complain(
            "particle_spacing",
            message,
            &format!("at most {}", grouped(MAX_CELLS as u64)),
            &hint,
        ));
    }
    Ok(())
}

fn check_block(section: &Section<'_>, block: &Block, domain: &Domain, spacing: f32) -> Result<(), Reported> {
    let (low, high) = block.shape.bounds();
    let place = if section.has("size") { ["position", "size"] } else { ["center", "radius"] };
    let slack = SLACK * spacing;
    let axes = ["x", "y", "z"];
    for axis in 0..3 {
        let (name, edge, out) = if low[axis] < domain.min[axis] - slack {
            (place[0], low[axis], domain.min[axis] - low[axis])
        } else if high[axis] > domain.max[axis] + slack {
            (place[1], high[axis], high[axis] - domain.max[axis])
        } else {
            continue;
        };
        let side = axes[axis];
        let message = format!(
            "{} reaches out of the domain: its edge at {side} = {edge} m is {} m outside",
            section.path(),
            rounded(out)
        );
        let allowed = format!("{side} from {} to {} m", domain.min[axis], domain.max[axis]);
        return Err(section.complain(
            name,
            message,
            &allowed,
            "move or shrink the block, or enlarge the domain",
        ));
    }
    let thinnest = (high - low).min_element();
    if (thinnest / spacing).round() < 1.0 {
        let message = format!(
            "{} is {} m thin and holds no particles at a spacing of {spacing} m",
            section.path(),
            rounded(thinnest)
        );
        return Err(section.complain(
            place[1],
            message,
            &format!("at least {spacing} m"),
            "enlarge the block or refine fluid.particle_spacing",
        ));
    }
    Ok(())
}

/// Warns where blocks overlap; particles of the later one are left out.
fn report_overlaps(domain: &Domain, fluid: &Fluid, blocks: &[ReadBlock<'_>]) {
    for (sampler, (_, section)) in Sampler::all(domain, fluid).iter().zip(blocks) {
        let (created, left_out) = sampler.counts();
        if left_out > 0 {
            let message = format!(
                "{} overlaps earlier blocks: {} of its {} particles are left out",
                section.path(),
                grouped(left_out),
                grouped(created + left_out)
            );
            let name = if section.has("position") { "position" } else { "center" };
            section.warn(name, message, "the particles there have the earlier block's velocity");
        }
    }
}

/// A number with separators of thousands: 1,234,567.
pub(crate) fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let groups: Vec<&str> =
        digits.as_bytes().rchunks(3).rev().filter_map(|group| std::str::from_utf8(group).ok()).collect();
    groups.join(",")
}
