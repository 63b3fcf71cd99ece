//! Perceptual colour maps.

use wgpu::{Device, Queue, TextureView};

/// A colour map. All except [`ColourMap::BlueRed`] increase monotonically in lightness, so that
/// they also work in greyscale.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum ColourMap {
    /// Deep blue over turquoise to white, for water.
    #[default]
    Water,
    /// Violet over green to yellow (van der Walt and Smith 2015), common in scientific plots.
    Viridis,
    /// Black over purple and orange to pale yellow (van der Walt and Smith 2015).
    Inferno,
    /// Blue over white to red, a diverging map (ColorBrewer RdBu, Brewer 2003).
    BlueRed,
}

/// Evenly spaced sRGB colours, linearly interpolated.
const WATER: [u32; 9] =
    [0x13296b, 0x154389, 0x195ea8, 0x217bbf, 0x309ace, 0x55b8db, 0x8bd2e6, 0xc3e7f0, 0xf6fbfc];
const VIRIDIS: [u32; 11] = [
    0x440154, 0x482576, 0x414487, 0x35608d, 0x2a788e, 0x21908c, 0x22a884, 0x43bf71, 0x7ad151, 0xbbdf27,
    0xfde725,
];
const INFERNO: [u32; 11] = [
    0x000004, 0x160b39, 0x420a68, 0x6a176e, 0x932667, 0xbc3754, 0xdd513a, 0xf3771a, 0xfca50a, 0xf6d645,
    0xfcffa4,
];
const BLUE_RED: [u32; 9] =
    [0x2166ac, 0x4393c3, 0x92c5de, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xf4a582, 0xd6604d, 0xb2182b];

impl ColourMap {
    /// All maps.
    pub const ALL: [ColourMap; 4] =
        [ColourMap::Water, ColourMap::Viridis, ColourMap::Inferno, ColourMap::BlueRed];

    /// Name in lower case, as in scene files and menus.
    pub fn name(self) -> &'static str {
        match self {
            ColourMap::Water => "water",
            ColourMap::Viridis => "viridis",
            ColourMap::Inferno => "inferno",
            ColourMap::BlueRed => "blue-red",
        }
    }

    /// The map of that name.
    pub fn from_name(name: &str) -> Option<ColourMap> {
        ColourMap::ALL.into_iter().find(|map| map.name() == name)
    }

    /// The sRGB colour at `t` in [0, 1]. Values outside are clamped; NaN gives the colour at 0.
    pub fn sample(self, t: f32) -> [u8; 3] {
        let stops: &[u32] = match self {
            ColourMap::Water => &WATER,
            ColourMap::Viridis => &VIRIDIS,
            ColourMap::Inferno => &INFERNO,
            ColourMap::BlueRed => &BLUE_RED,
        };
        let place = if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) * (stops.len() - 1) as f32 };
        let below = (place as usize).min(stops.len() - 2);
        let fraction = place - below as f32;
        [16, 8, 0].map(|shift| {
            let channel = |stop: u32| (stop >> shift & 0xff) as f32;
            let low = channel(stops[below]);
            (low + fraction * (channel(stops[below + 1]) - low)).round() as u8
        })
    }

    /// The map as 256 RGBA texels.
    pub(crate) fn texels(self) -> Vec<u8> {
        (0..256)
            .flat_map(|i| {
                let [r, g, b] = self.sample(i as f32 / 255.0);
                [r, g, b, 255]
            })
            .collect()
    }
}

/// All maps as textures of 256 x 1 texels.
#[derive(Clone, Debug)]
pub(crate) struct ColourTextures([TextureView; ColourMap::ALL.len()]);

impl ColourTextures {
    pub fn new(device: &Device, queue: &Queue) -> ColourTextures {
        ColourTextures(
            ColourMap::ALL.map(|map| {
                crate::texture::upload_texture(device, queue, "colour map", [256, 1], &map.texels())
            }),
        )
    }

    pub fn of(&self, map: ColourMap) -> &TextureView {
        // The order of ALL is that of the variants.
        &self.0[map as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// CIE lightness, 0 to 100.
    fn lightness([r, g, b]: [u8; 3]) -> f32 {
        let linear = |c: u8| match f32::from(c) / 255.0 {
            c if c <= 0.04045 => c / 12.92,
            c => ((c + 0.055) / 1.055).powf(2.4),
        };
        let y = 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
        if y > 0.008856 { 116.0 * y.cbrt() - 16.0 } else { 903.3 * y }
    }

    #[test]
    fn values_at_the_ends_and_out_of_range() {
        assert_eq!(ColourMap::Viridis.sample(0.0), [0x44, 0x01, 0x54]);
        assert_eq!(ColourMap::Viridis.sample(1.0), [0xfd, 0xe7, 0x25]);
        for map in ColourMap::ALL {
            assert_eq!(map.sample(-3.0), map.sample(0.0));
            assert_eq!(map.sample(f32::INFINITY), map.sample(1.0));
            assert_eq!(map.sample(f32::NAN), map.sample(0.0));
            assert_eq!(map.texels().len(), 1024);
            assert_eq!(ColourMap::from_name(map.name()), Some(map));
        }
        assert_eq!(ColourMap::from_name("jet"), None);
    }

    #[test]
    fn sequential_maps_increase_smoothly_in_lightness() {
        let steps = |map: ColourMap| -> Vec<f32> {
            let light: Vec<f32> = (0..=32).map(|i| lightness(map.sample(i as f32 / 32.0))).collect();
            light.windows(2).map(|pair| pair[1] - pair[0]).collect()
        };
        for map in [ColourMap::Water, ColourMap::Viridis, ColourMap::Inferno] {
            let steps = steps(map);
            assert!(steps.iter().all(|&step| step > 0.3 && step < 6.0), "{map:?} {steps:?}");
        }
        // Negative control: the diverging map is darker at both ends.
        assert!(steps(ColourMap::BlueRed).iter().any(|&step| step < 0.0));
    }
}
