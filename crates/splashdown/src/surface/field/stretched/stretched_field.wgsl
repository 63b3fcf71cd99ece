#import gpu/index
#import sph/grid
#import surface/lattice
#import surface/walls
#import sph/kernel
#import surface/candidates
#import surface/field_row

#bindings

// The ellipsoid of a sample.
fn contribution(i: u32, by: WallReflection, nodes: RowNodes) -> RowValues {
    let none = RowValues(vec4<f32>(0.0), vec4<f32>(0.0));
    let sample = samples[i];
    let at = by.sign * sample.xyz + by.shift;
    let d = nodes.yz - at.yz;
    let outside = distance_outside(nodes, at.x);
    let distance2 = dot(d, d) + outside * outside;
    if distance2 >= lattice.reach * lattice.reach {
        return none;
    }
    // z: the square of a bound of the half-axes
    let more = kernel_matrices[2u * i + 1u];
    if distance2 >= more.z {
        return none;
    }
    // The signs of the elements xy, xz, yz of the matrix of an image.
    let mixed = by.sign.xxy * by.sign.yzz;
    // q^2 = (xx a + linear) a + constant at the distance a along x.
    let shape = kernel_matrices[2u * i];
    let linear = 2.0 * (mixed.x * shape.y * d.x + mixed.y * shape.z * d.y);
    let constant = (shape.w * d.x + 2.0 * mixed.z * more.x * d.y) * d.x + more.y * d.y * d.y;
    // The least value within the row.
    let lowest = clamp(-0.5 * linear / shape.x, nodes.first_x - at.x, nodes.last_x - at.x);
    if (shape.x * lowest + linear) * lowest + constant >= 1.0 {
        return none;
    }
    let a = nodes.low_x - at.x;
    let b = nodes.high_x - at.x;
    return RowValues(
        sample.w * kernel_w4(sqrt(max((shape.x * a + linear) * a + constant, vec4<f32>(0.0)))),
        sample.w * kernel_w4(sqrt(max((shape.x * b + linear) * b + constant, vec4<f32>(0.0)))),
    );
}

@compute @workgroup_size(64)
fn stretched_field(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) row: u32,
) {
    let slot = linear_group(group, groups);
    if slot < status.blocks {
        evaluate_row(slot, row);
    }
}
