//! Large pictures in tiles.
//!
//! # How it works
//! A picture that is larger than a texture of the device, or than [`MOST_PIXELS`], is drawn in tiles,
//! which the host puts together. Every tile is drawn with the part of the camera's projection that it
//! shows, into textures of one size. What depends on the place of a pixel uses its place in the whole
//! picture: rays, pseudo-random numbers, and the corners of blocks of 2 x 2 pixels, for which corners of
//! tiles are even.
//!
//! *Borders.* Passes that read neighbouring pixels need some around a tile, which are drawn and left out:
//! the texels of the thickness of the liquid from which the normal of its far side follows, or the reach of
//! the filters of a liquid of particles.
//!
//! *Refraction* without traced rays reads the picture behind the liquid, and the distances of bodies, anywhere.
//! The scenes of all tiles are therefore drawn first, into the layers of two textures; see `Targets::scenes` and
//! `shared/picture_behind.wgsl`.
//!
//! With lavapipe a tiled picture equals the same picture in one piece but for single pixels at outlines,
//! where the rounding of the projection moves an edge by up to 1/256 of a pixel: see the tests.
//!
//! # Why not the other way
//! A viewport that extends beyond the texture would need no other projection, but WebGPU limits it to the
//! size of the largest texture. A border as wide as refraction reaches is as large as the picture. Scenes at
//! a lower resolution for it would show seams.
//!
//! # Things we might try
//! Writing each row of tiles into the file at once, for pictures that do not fit into the memory of the host.

use crate::RenderError;
use crate::globals::Globals;
use glam::{Mat4, Vec2, Vec4};

/// Largest side of a picture that is read back.
pub(crate) const MAX_SIDE: u32 = 32_768;
/// Largest number of pixels of a picture that is read back: 1 GiB of RGBA.
pub(crate) const MAX_PIXELS: u64 = 1 << 28;
/// Largest number of pixels of a tile. Pictures of 3840 x 2160 are not divided.
pub(crate) const MOST_PIXELS: u64 = 9_000_000;
/// What a tile takes on the device with four samples per pixel: `targets.rs`, the result and its read-back.
pub(crate) const BYTES_PER_PIXEL: u64 = 80;
/// One texel of the thickness of the liquid.
const LEAST_BORDER: u32 = 2;
/// Largest distance at which the normal of the far side of a liquid reads its thickness, over the height of the picture.
const EXIT_REACH: f32 = 0.03;
/// And in pixels, so that the border of tiles remains small.
const LARGEST_EXIT_REACH: f32 = 32.0;

/// How a picture is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Tiling {
    picture: [u32; 2],
    /// Size of the textures: of a tile with its border.
    texture: [u32; 2],
    border: u32,
    /// Number of columns and rows.
    grid: [u32; 2],
}

/// A tile of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Tile {
    pub tiling: Tiling,
    /// Row by row.
    pub index: u32,
}

/// The part of a tile that belongs to the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Visible {
    /// Corner in the texture.
    pub in_texture: [u32; 2],
    /// Corner in the picture.
    pub in_picture: [u32; 2],
    pub size: [u32; 2],
}

/// Refuses pictures that are empty or too large to be put together.
pub(crate) fn check_picture([width, height]: [u32; 2]) -> Result<(), RenderError> {
    if ![width, height].iter().all(|side| (1..=MAX_SIDE).contains(side)) {
        return Err(RenderError::PictureSize { width, height, limit: MAX_SIDE });
    }
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(RenderError::TooManyPixels { width, height, limit: MAX_PIXELS });
    }
    Ok(())
}

/// Largest distance in whole pixels at which the normal of the far side of a liquid reads its thickness.
pub(crate) fn exit_reach([_, height]: [u32; 2]) -> f32 {
    (EXIT_REACH * height as f32).clamp(2.0, LARGEST_EXIT_REACH).floor()
}

/// Pixels around a tile of a picture of this size from which the normal of the far side of a liquid follows.
pub(crate) fn around_exit(picture: [u32; 2]) -> u32 {
    (exit_reach(picture) as u32 + LEAST_BORDER).next_multiple_of(2)
}

/// The number of pixels of all tiles of a picture of a mesh together, with their borders, on a device whose textures have up
/// to `side` pixels a side; 0 for a picture in one piece.
pub(crate) fn pixels_of_tiles(picture: [u32; 2], side: u32) -> u64 {
    let tiling = Tiling::new(picture, texture_size(picture, side), around_exit(picture));
    if tiling.count() == 1 {
        return 0;
    }
    u64::from(tiling.count()) * u64::from(tiling.texture[0]) * u64::from(tiling.texture[1])
}

/// The size of the textures for a picture, on a device with this largest side of a texture.
pub(crate) fn texture_size(picture: [u32; 2], largest_side: u32) -> [u32; 2] {
    texture_within(picture, largest_side, MOST_PIXELS)
}

fn texture_within(picture: [u32; 2], largest_side: u32, most_pixels: u64) -> [u32; 2] {
    let pixels = |[width, height]: [u32; 2]| u64::from(width) * u64::from(height);
    if picture.iter().all(|&side| side <= largest_side) && pixels(picture) <= most_pixels {
        return picture;
    }
    let mut grid = [1, 1];
    loop {
        let texture = [0, 1].map(|axis: usize| {
            picture[axis].div_ceil(grid[axis]).next_multiple_of(2) + 2 * around_exit(picture)
        });
        // The filters of a liquid of particles have a margin of their own.
        let fits = texture.iter().all(|side| side + 2 * crate::screen_space::MARGIN <= largest_side);
        if (fits && pixels(texture) <= most_pixels) || texture[0].max(texture[1]) < 16 {
            return texture;
        }
        grid[usize::from(texture[1] > texture[0])] += 1;
    }
}

impl Tiling {
    /// A picture in one piece.
    pub fn whole(picture: [u32; 2]) -> Tiling {
        Tiling { picture, texture: picture, border: 0, grid: [1, 1] }
    }

    /// Tiles in textures of this size, of which the passes of a frame need a border. A border of more than a
    /// sixth of the texture would be more work than the picture, and is smaller.
    pub fn new(picture: [u32; 2], texture: [u32; 2], border: u32) -> Tiling {
        if texture == picture {
            return Tiling::whole(picture);
        }
        let most = (texture[0].min(texture[1]) / 6).max(LEAST_BORDER) & !1;
        Tiling::with_border(picture, texture, border.next_multiple_of(2).clamp(LEAST_BORDER, most))
    }

    /// As [`new`](Self::new), with exactly this border.
    pub fn with_border(picture: [u32; 2], texture: [u32; 2], border: u32) -> Tiling {
        let grid = [0, 1].map(|axis: usize| picture[axis].div_ceil(texture[axis] - 2 * border));
        Tiling { picture, texture, border, grid }
    }

    /// The size of the textures.
    pub fn texture(&self) -> [u32; 2] {
        self.texture
    }

    /// The size of the picture.
    pub fn picture(&self) -> [u32; 2] {
        self.picture
    }

    /// The number of tiles.
    pub fn count(&self) -> u32 {
        self.grid[0] * self.grid[1]
    }

    /// All tiles.
    pub fn tiles(self) -> impl Iterator<Item = Tile> {
        (0..self.count()).map(move |index| Tile { tiling: self, index })
    }

    /// From a tile to the next.
    fn stride(&self) -> [u32; 2] {
        self.texture.map(|side| side - 2 * self.border)
    }
}

impl Tile {
    /// The only tile of a picture in one piece.
    pub fn whole(picture: [u32; 2]) -> Tile {
        Tile { tiling: Tiling::whole(picture), index: 0 }
    }

    fn place(&self) -> [u32; 2] {
        [self.index % self.tiling.grid[0], self.index / self.tiling.grid[0]]
    }

    /// The corner of the texture in the picture. It lies outside at the left and at the top.
    pub fn corner(&self) -> [f32; 2] {
        let (place, stride) = (self.place(), self.tiling.stride());
        [0, 1].map(|axis: usize| (place[axis] * stride[axis]) as f32 - self.tiling.border as f32)
    }

    /// The part that belongs to the picture.
    pub fn visible(&self) -> Visible {
        let (place, stride) = (self.place(), self.tiling.stride());
        let in_picture = [0, 1].map(|axis: usize| place[axis] * stride[axis]);
        let size = [0, 1].map(|axis: usize| stride[axis].min(self.tiling.picture[axis] - in_picture[axis]));
        Visible { in_texture: [self.tiling.border; 2], in_picture, size }
    }

    /// Changes the uniforms of the whole picture to those of the tile.
    pub fn fill(&self, globals: &mut Globals) {
        let pair = |sides: [u32; 2]| sides.map(|side| side as f32);
        globals.target_size = pair(self.tiling.texture);
        globals.tile_corner = self.corner();
        globals.tile_stride = pair(self.tiling.stride());
        globals.tile_grid = pair(self.tiling.grid);
        globals.tile_border = self.tiling.border as f32;
        if self.tiling.count() > 1 {
            let in_border = self.tiling.border.saturating_sub(LEAST_BORDER).max(1) as f32;
            globals.exit_reach = globals.exit_reach.min(in_border);
            let clip_from_world =
                self.target_from_picture() * Mat4::from_cols_array_2d(&globals.clip_from_world);
            globals.clip_from_world = clip_from_world.to_cols_array_2d();
        }
    }

    /// From the clip space of the picture to that of the texture.
    fn target_from_picture(&self) -> Mat4 {
        let sides = |sides: [u32; 2]| Vec2::from(sides.map(|side| side as f32));
        let (picture, texture) = (sides(self.tiling.picture), sides(self.tiling.texture));
        let (scale, corner) = (picture / texture, Vec2::from(self.corner()));
        // The middle of the picture minus that of the texture, in halves of the texture. Downwards y is positive in pixels.
        let shift = (picture - 2.0 * corner - texture) / texture;
        // The shift is of positions after the division by w.
        Mat4::from_cols(
            Vec4::new(scale.x, 0.0, 0.0, 0.0),
            Vec4::new(0.0, scale.y, 0.0, 0.0),
            Vec4::Z,
            Vec4::new(shift.x, -shift.y, 0.0, 1.0),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once() {
        for (picture, texture, border) in [
            ([100, 60], [40, 30], 2),
            ([101, 59], [38, 44], 6),
            ([64, 64], [64, 64], 8),
            ([300, 16], [96, 20], 2),
        ] {
            let tiling = Tiling::new(picture, texture, border);
            let mut drawn = vec![0; (picture[0] * picture[1]) as usize];
            for tile in tiling.tiles() {
                let Visible { in_texture, in_picture, size } = tile.visible();
                assert!((0..2).all(|axis| in_texture[axis] + size[axis] <= texture[axis]), "{tile:?}");
                for axis in 0..2 {
                    let corner = in_picture[axis] as f32 - in_texture[axis] as f32;
                    assert!(tile.corner()[axis] == corner && corner % 2.0 == 0.0, "{tile:?}");
                }
                for (x, y) in (0..size[0]).flat_map(|x| (0..size[1]).map(move |y| (x, y))) {
                    drawn[((in_picture[1] + y) * picture[0] + in_picture[0] + x) as usize] += 1;
                }
            }
            assert!(drawn.iter().all(|&times| times == 1), "{tiling:?}");
        }
    }

    #[test]
    fn textures_fit_the_device_and_small_pictures_are_not_divided() {
        assert_eq!(texture_size([3840, 2160], 8192), [3840, 2160]);
        for (picture, limit) in
            [([12_000, 8000], 8192), ([32_768, 8192], 4096), ([9000, 16], 8192), ([7680, 4320], 16_384)]
        {
            let texture = texture_size(picture, limit);
            let pixels = u64::from(texture[0]) * u64::from(texture[1]);
            assert!(
                texture.iter().all(|&side| side < limit && side % 2 == 0) && pixels <= MOST_PIXELS,
                "{texture:?}"
            );
            // Not many more than necessary.
            let tiles = u64::from(Tiling::new(picture, texture, 0).count());
            let whole = u64::from(picture[0]) * u64::from(picture[1]);
            assert!(
                tiles <= 2 * whole.div_ceil(MOST_PIXELS).max(u64::from(picture[0].div_ceil(limit))),
                "{tiles}"
            );
        }
        // The layers of the scenes: WebGPU guarantees 256.
        for border in [2, 100, 10_000] {
            let picture = [32_768, 8192];
            assert!(Tiling::new(picture, texture_size(picture, 8192), border).count() <= 256);
        }
    }

    #[test]
    fn a_point_is_at_the_same_pixel_of_the_picture_in_every_tile() {
        let tiling = Tiling::new([200, 120], [64, 48], 4);
        let seen = Vec4::new(0.3, -0.7, 0.1, 2.0);
        let pixel = |clip: Vec4, [width, height]: [u32; 2]| {
            let (x, y) = (clip.x / clip.w, clip.y / clip.w);
            Vec2::new((0.5 + 0.5 * x) * width as f32, (0.5 - 0.5 * y) * height as f32)
        };
        for tile in tiling.tiles() {
            let in_tile = pixel(tile.target_from_picture() * seen, tiling.texture());
            let expected = pixel(seen, tiling.picture());
            assert!((in_tile + Vec2::from(tile.corner())).distance(expected) < 1e-3, "{tile:?}");
            // Negative control.
            assert!((in_tile + Vec2::from(tile.corner()) + Vec2::X).distance(expected) > 0.9);
        }
    }

    #[test]
    fn pictures_that_are_too_large_are_refused_with_the_limit() {
        assert!(check_picture([32_768, 8192]).is_ok());
        let message = |size| check_picture(size).unwrap_err().to_string();
        assert!(message([0, 5]).contains("between 1 and 32768"));
        assert!(message([40_000, 5]).contains("between 1 and 32768"));
        assert!(message([32_768, 8193]).contains("268 million"));
    }
}
