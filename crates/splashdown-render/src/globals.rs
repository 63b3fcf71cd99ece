//! Uniforms of every shader of a frame; mirrors `Globals` in `shared/globals.wgsl`.

use bytemuck::{Pod, Zeroable};

/// Texels on a side of the shadow map.
pub(crate) const SHADOW_SIDE: u32 = 256;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct EdgeGlobals {
    pub start: [f32; 3],
    pub opacity: f32,
    pub end: [f32; 3],
    pub dashes: f32,
}

/// The WGSL file documents meanings and units. A test compares names and offsets.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct Globals {
    pub clip_from_world: [[f32; 4]; 4],
    pub eye: [f32; 3],
    pub near: f32,
    pub right: [f32; 3],
    pub pixel_angle: f32,
    pub up: [f32; 3],
    pub encode_srgb: u32,
    pub forward: [f32; 3],
    pub hill_height: f32,
    pub sun: [f32; 3],
    pub floor_height: f32,
    pub box_min: [f32; 3],
    pub tile_size: f32,
    pub box_max: [f32; 3],
    pub fade_distance: f32,
    pub shadow_min: [f32; 2],
    pub shadow_size: [f32; 2],
    pub picture_size: [f32; 2],
    pub line_width: f32,
    pub particle_radius: f32,
    pub shadow_absorption: [f32; 3],
    pub shadow_particle_path: f32,
    pub quantity: u32,
    pub range_low: f32,
    pub range_scale: f32,
    pub refractive_index: f32,
    pub liquid_absorption: [f32; 3],
    pub liquid_scattering: f32,
    pub liquid_colour: [f32; 3],
    pub liquid_roughness: f32,
    pub splat_radius: f32,
    pub thickness_radius: f32,
    pub particle_thickness: f32,
    pub slice_quantity: u32,
    pub slice_axis: u32,
    pub slice_position: f32,
    pub slice_support_radius: f32,
    pub slice_full: f32,
    pub slice_low: f32,
    pub slice_scale: f32,
    pub splat_margin: f32,
    pub foam_radius: f32,
    pub droplet_radius: f32,
    pub droplet_shutter: f32,
    pub water_root: u32,
    pub body_root: u32,
    pub foam_light: [f32; 3],
    pub foam_shutter: f32,
    pub ray_shift: [f32; 3],
    pub linear_output: u32,
    pub glass: [u32; 4],
    pub zenith: [f32; 3],
    pub floor_pattern: u32,
    pub horizon: [f32; 3],
    pub cloud_cover: f32,
    pub clouds: [f32; 3],
    pub cloud_opacity: f32,
    pub sun_light: [f32; 3],
    pub ray_offset: f32,
    pub sky_light: [f32; 3],
    pub contact_distance: f32,
    pub glow: [f32; 3],
    pub sample: u32,
    pub haze: [f32; 3],
    pub sample_count: u32,
    pub hills: [f32; 3],
    pub shutter_time: f32,
    pub floor_tint: [f32; 3],
    pub glass_thickness: f32,
    pub bounced: [f32; 3],
    pub sunlit_panes: u32,
    pub body_heights: [f32; 2],
    pub tile_corner: [f32; 2],
    pub target_size: [f32; 2],
    pub tile_stride: [f32; 2],
    pub tile_grid: [f32; 2],
    pub tile_border: f32,
    pub exit_reach: f32,
    pub edges: [EdgeGlobals; 12],
}

impl Globals {
    /// Sets the path length that a particle of this radius adds to a texel of the shadow map.
    pub fn set_shadow_of_particles(&mut self, radius: f32) {
        let texel_area = self.shadow_size[0] * self.shadow_size[1] / (SHADOW_SIDE as f32).powi(2);
        self.shadow_particle_path = (2.0 * radius).powi(3) / (texel_area * self.sun[1]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::mem::{offset_of, size_of};

    /// Name and byte offset of each member.
    macro_rules! layout {
        ($type:ty: $($field:ident)*) => { [$((stringify!($field), offset_of!($type, $field))),*] };
    }

    fn wgsl_layout(source: &str, name: &str) -> (Vec<(String, usize)>, usize) {
        let module = naga::front::wgsl::parse_str(source).unwrap();
        let (_, found) = module.types.iter().find(|(_, t)| t.name.as_deref() == Some(name)).unwrap();
        let naga::TypeInner::Struct { members, span } = &found.inner else {
            panic!("{name} is not a struct")
        };
        let named = |member: &naga::StructMember| (member.name.clone().unwrap(), member.offset as usize);
        (members.iter().map(named).collect(), *span as usize)
    }

    fn same(source: &str) -> bool {
        let globals = layout!(Globals: clip_from_world eye near right pixel_angle up encode_srgb forward
            hill_height sun floor_height box_min tile_size box_max fade_distance shadow_min shadow_size
            picture_size line_width particle_radius shadow_absorption shadow_particle_path quantity range_low
            range_scale refractive_index liquid_absorption liquid_scattering liquid_colour liquid_roughness
            splat_radius thickness_radius particle_thickness slice_quantity slice_axis slice_position slice_support_radius
            slice_full slice_low slice_scale splat_margin foam_radius droplet_radius droplet_shutter water_root body_root foam_light foam_shutter ray_shift linear_output glass
            zenith floor_pattern horizon cloud_cover clouds cloud_opacity sun_light ray_offset sky_light
            contact_distance glow sample haze sample_count hills shutter_time floor_tint glass_thickness bounced
            sunlit_panes body_heights tile_corner target_size tile_stride tile_grid tile_border exit_reach edges);
        let edge = layout!(EdgeGlobals: start opacity end dashes);
        let owned =
            |layout: &[(&str, usize)]| layout.iter().map(|(n, o)| ((*n).to_owned(), *o)).collect::<Vec<_>>();
        wgsl_layout(source, "Globals") == (owned(&globals), size_of::<Globals>())
            && wgsl_layout(source, "Edge") == (owned(&edge), size_of::<EdgeGlobals>())
    }

    #[test]
    fn rust_and_wgsl_agree() {
        // Only the declarations: the functions below them do not compile with the changed names.
        let source = include_str!("shared/globals.wgsl").split("@group").next().unwrap();
        assert!(same(source));
        // Negative controls: a renamed, a moved and a removed member.
        assert!(!same(&source.replace("near: f32", "nearest: f32")));
        assert!(!same(&source.replace("shadow_size: vec2f,", "shadow_size: vec3f,")));
        assert!(!same(&source.replace("    line_width: f32,", "    ")));
    }
}
