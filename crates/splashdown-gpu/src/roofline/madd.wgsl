#import gpu/index

#bindings

override LINKS: u32;

@compute @workgroup_size(256)
fn madd(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(id, groups, 256u);
    if (i >= arrayLength(&values)) {
        return;
    }
    let x = values[i];
    // Eight independent chains.
    var a = x;
    var b = x;
    var c = x;
    var d = x;
    var e = x;
    var f = x;
    var g = x;
    var h = x;
    for (var link = 0u; link < LINKS; link++) {
        a = fma(a, vec4<f32>(0.0), a);
        b = fma(b, vec4<f32>(1e-4), b);
        c = fma(c, vec4<f32>(2e-4), c);
        d = fma(d, vec4<f32>(3e-4), d);
        e = fma(e, vec4<f32>(4e-4), e);
        f = fma(f, vec4<f32>(5e-4), f);
        g = fma(g, vec4<f32>(6e-4), g);
        h = fma(h, vec4<f32>(7e-4), h);
    }
    results[i] = ((a + b) + (c + d)) + ((e + f) + (g + h));
}
