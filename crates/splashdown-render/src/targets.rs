//! Textures that depend on the size of the picture.

use crate::pipeline::DEPTH;
use wgpu::{
    CommandEncoder, Device, Extent3d, Texture, TextureFormat, TextureUsages, TextureView,
    TextureViewDescriptor, TextureViewDimension,
};

pub(crate) const THICKNESS_FORMAT: TextureFormat = TextureFormat::R16Float;
/// Two integers per normal: see `surface/normal_code.wgsl`.
pub(crate) const NORMAL_FORMAT: TextureFormat = TextureFormat::Rg16Uint;
/// With eight bits, many faint particles would add up to the wrong opacity.
pub(crate) const LAYER_FORMAT: TextureFormat = TextureFormat::Rgba16Float;

#[derive(Debug)]
pub(crate) struct Targets {
    pub size: [u32; 2],
    /// The picture with several samples per pixel; absent with one sample.
    pub samples: Option<TextureView>,
    pub depth: TextureView,
    /// The picture without the liquid.
    pub scene: TextureView,
    /// That of every tile, because refraction reads from all of them.
    pub scenes: OfTiles,
    /// Length of the view ray inside the liquid, at half resolution.
    pub thickness: TextureView,
    /// Relative distance of the nearest body, at half resolution.
    pub solid: TextureView,
    /// That of every tile.
    pub solids: OfTiles,
    /// Created with the first mesh.
    pub mesh: Option<MeshTargets>,
    /// Created with the first foam.
    pub foam: Option<FoamTargets>,
}

/// What a mesh of the liquid needs.
#[derive(Debug)]
pub(crate) struct MeshTargets {
    /// Normals of the surface, with as many samples as the picture.
    pub normals: TextureView,
    /// The pixels that the surface covers: a depth buffer of zeros among ones.
    pub covered: TextureView,
    /// The shaded liquid, with one sample per pixel; absent if the picture has only one sample too.
    pub liquid: Option<TextureView>,
}

/// What foam needs.
#[derive(Debug)]
pub(crate) struct FoamTargets {
    /// The foam with one sample per pixel: colours times opacity, and the opacity.
    pub colours: TextureView,
    /// The depths of the picture with one sample per pixel; absent if the picture has only one.
    pub depths: Option<TextureView>,
}

impl Targets {
    /// Textures of this size; `layers`: the number of scenes.
    pub fn new(
        device: &Device,
        size: [u32; 2],
        layers: u32,
        format: TextureFormat,
        sample_count: u32,
    ) -> Targets {
        let half = size.map(|side| side.div_ceil(2));
        let drawn = TextureUsages::RENDER_ATTACHMENT;
        let read = drawn | TextureUsages::TEXTURE_BINDING;
        let make = |label, size, format, samples, usage| texture(device, label, size, format, samples, usage);
        let copied = read | TextureUsages::COPY_SRC;
        let scene = texture_of_layers(device, "scene", size, 1, format, copied);
        let solid = texture_of_layers(device, "distance of bodies", half, 1, THICKNESS_FORMAT, copied);
        Targets {
            size,
            samples: (sample_count > 1).then(|| make("samples", size, format, sample_count, drawn)),
            depth: make("depth", size, DEPTH, sample_count, read),
            scene: scene.create_view(&TextureViewDescriptor::default()),
            scenes: OfTiles::new(device, "scenes", scene, layers),
            thickness: make("thickness", half, THICKNESS_FORMAT, 1, read),
            solid: solid.create_view(&TextureViewDescriptor::default()),
            solids: OfTiles::new(device, "distances of bodies", solid, layers),
            mesh: None,
            foam: None,
        }
    }
}

impl Targets {
    /// Whether these textures are of this size, with enough layers for the scenes.
    pub fn suit(&self, size: [u32; 2], layers: u32) -> bool {
        self.size == size && self.scenes.count >= layers
    }
}

/// A texture of all tiles, in the layers of one texture.
#[derive(Debug)]
pub(crate) struct OfTiles {
    /// All layers.
    pub view: TextureView,
    /// That of the tile that is drawn.
    drawn: Texture,
    /// Absent in a picture of one tile.
    layers: Option<Texture>,
    count: u32,
}

impl OfTiles {
    fn new(device: &Device, label: &str, drawn: Texture, count: u32) -> OfTiles {
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let Extent3d { width, height, .. } = drawn.size();
        let make = || texture_of_layers(device, label, [width, height], count, drawn.format(), usage);
        let layers = (count > 1).then(make);
        let view = layers.as_ref().unwrap_or(&drawn).create_view(&TextureViewDescriptor {
            dimension: Some(TextureViewDimension::D2Array),
            ..Default::default()
        });
        OfTiles { view, drawn, layers, count }
    }

    /// Copies the texture of a tile to its layer. Drivers of lavapipe resolve several samples per pixel only into the first
    /// layer of a texture.
    pub fn record(&self, encoder: &mut CommandEncoder, tile: u32) {
        let Some(layers) = &self.layers else { return };
        let mut layer = layers.as_image_copy();
        layer.origin.z = tile;
        encoder.copy_texture_to_texture(self.drawn.as_image_copy(), layer, self.drawn.size());
    }
}

/// A two-dimensional texture with several layers.
fn texture_of_layers(
    device: &Device,
    label: &str,
    [width, height]: [u32; 2],
    layers: u32,
    format: TextureFormat,
    usage: TextureUsages,
) -> Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: Extent3d { width, height, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

impl MeshTargets {
    pub fn new(device: &Device, size: [u32; 2], format: TextureFormat, sample_count: u32) -> MeshTargets {
        let drawn = TextureUsages::RENDER_ATTACHMENT;
        let read = drawn | TextureUsages::TEXTURE_BINDING;
        let shaded = || texture(device, "liquid", size, format, 1, read);
        MeshTargets {
            normals: texture(device, "normals", size, NORMAL_FORMAT, sample_count, read),
            covered: texture(device, "covered", size, DEPTH, 1, drawn),
            liquid: (sample_count > 1).then(shaded),
        }
    }
}

impl FoamTargets {
    pub fn new(device: &Device, size: [u32; 2], sample_count: u32) -> FoamTargets {
        let drawn = TextureUsages::RENDER_ATTACHMENT;
        let read = drawn | TextureUsages::TEXTURE_BINDING;
        let depths = || texture(device, "depths of foam", size, DEPTH, 1, drawn);
        FoamTargets {
            colours: texture(device, "foam", size, LAYER_FORMAT, 1, read),
            depths: (sample_count > 1).then(depths),
        }
    }
}

/// A two-dimensional texture without mip maps.
pub(crate) fn texture(
    device: &Device,
    label: &str,
    [width, height]: [u32; 2],
    format: TextureFormat,
    sample_count: u32,
    usage: TextureUsages,
) -> TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    });
    texture.create_view(&TextureViewDescriptor::default())
}
