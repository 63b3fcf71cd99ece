"""Sky and floor of a scene as images: the formulas of environment.wgsl in NumPy. y is up."""

import numpy as np

F = np.float32


def fract(x):
    return x - np.floor(x)


def hashed(x, y):
    qx, qy = fract(x * F(0.1031)), fract(y * F(0.1030))
    dot = qx * (qy + F(33.33)) + qy * (qx + F(33.33))
    rx, ry = qx + dot, qy + dot
    return fract((rx + ry) * rx * F(7.13))


def value_noise(x, y):
    cx, cy = np.floor(x), np.floor(y)
    fx, fy = x - cx, y - cy
    wx, wy = fx * fx * (3 - 2 * fx), fy * fy * (3 - 2 * fy)
    low = hashed(cx, cy) * (1 - wx) + hashed(cx + 1, cy) * wx
    high = hashed(cx, cy + 1) * (1 - wx) + hashed(cx + 1, cy + 1) * wx
    return low * (1 - wy) + high * wy


def smoothstep(low, high, x):
    t = np.clip((x - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


def sky(direction, scene):
    """Light from the sky in unit directions, shape (..., 3)."""
    colours = {key: np.asarray(value, F) for key, value in scene["sky"].items()}
    sun = np.asarray(scene["sun"], F)
    sun = sun / np.linalg.norm(sun)
    x, y, z = (direction[..., axis] for axis in range(3))
    height = np.maximum(y, 0)
    up = (1 - np.exp(F(-4.2) * height))[..., None]
    light = colours["horizon"] * (1 - up) + colours["zenith"] * up

    flat = np.maximum(y, 0) + F(0.15)
    px, py = x / flat * F(1.4) + F(3.7), z / flat * F(1.4) + F(1.9)
    density = (
        0.55 * value_noise(px, py)
        + 0.30 * value_noise(2.3 * px, 2.3 * py)
        + 0.15 * value_noise(5.1 * px, 5.1 * py)
    )
    cover = colours["cloud_cover"]
    clouds = smoothstep(0.46 - cover, 0.82 - cover, density) * smoothstep(0.05, 0.35, y)
    clouds = (colours["cloud_opacity"] * np.where(y > 0.05, clouds, 0))[..., None]
    light = light * (1 - clouds) + colours["clouds"] * clouds

    from_sun = direction @ sun
    half_way = 0.5 + 0.5 * from_sun
    light = light + colours["glow"] * (half_way**3 * np.exp(-5 * height))[..., None]
    glow = np.maximum(from_sun, 0)
    aureole = 0.16 * glow**10 + 0.8 * glow**120 + 5 * glow**2400
    light = light + colours["sun_light"] * aureole[..., None]

    around = np.arctan2(z, x)
    hills = 0.030 + 0.014 * np.sin(3 * around + 1) + 0.009 * np.sin(7 * around + 4)
    hills = colours["hill_height"] * (hills + 0.004 * np.sin(17 * around))
    far = smoothstep(0, 0.03, height)[..., None]
    hill = colours["haze"] * (1 - far) + colours["hills"] * far
    above = smoothstep(-0.002, 0.002, y - hills)[..., None]
    return hill * (1 - above) + light * above


def sky_image(scene, width=3072):
    """The sky as an equirectangular image of Blender (z up), shape (height, width, 3), from the bottom row to the top."""
    height = width // 2
    around = np.pi - 2 * np.pi * (np.arange(width, dtype=F) + F(0.5)) / width
    up = np.pi * (np.arange(height, dtype=F) + F(0.5)) / height - np.pi / 2
    around, up = np.meshgrid(around.astype(F), up.astype(F))
    blender = np.stack([np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)], axis=-1)
    return sky(np.stack([blender[..., 0], blender[..., 2], -blender[..., 1]], axis=-1), scene)


def grid_lines(x, y, half_line, width):
    def covered(p):
        low, high = p - 0.5 * width + half_line, p + 0.5 * width + half_line
        a = np.floor(low) * 2 * half_line + np.minimum(fract(low), 2 * half_line)
        b = np.floor(high) * 2 * half_line + np.minimum(fract(high), 2 * half_line)
        return (b - a) / width

    return 1 - (1 - covered(x)) * (1 - covered(y))


def floor_albedo(x, z, floor, texel):
    """Reflectance of the floor at points; `texel` is the size of a texel in metres."""
    tint = np.asarray(floor["colour"], F) / F(0.07)
    x, y, width = x / floor["tile_size"], z / floor["tile_size"], texel / floor["tile_size"]
    if floor["pattern"] == "plain":
        return np.broadcast_to(tint * F(0.07), (*x.shape, 3))
    if floor["pattern"] == "checkerboard":
        dark = (np.floor(x) + np.floor(y)) % 2
        return tint * (0.105 + (0.035 - 0.105) * dark)[..., None]
    slab = hashed(np.floor(x) + F(0.5), np.floor(y) + F(0.5))
    coarse = value_noise(2.3 * x, 2.3 * y) - 0.5
    medium = (value_noise(9 * x + 5, 9 * y + 5) - 0.5) * np.clip(1.6 - 9 * width, 0, 1)
    fine = (value_noise(47 * x + 11, 47 * y + 11) - 0.5) * np.clip(1.6 - 47 * width, 0, 1)
    tone = 0.07 + 0.011 * (slab - 0.5) + 0.009 * coarse + 0.007 * medium + 0.009 * fine
    joint = grid_lines(x, y, 0.010, max(width, 1e-4))
    return tint * (tone * (1 - 0.55 * joint))[..., None]


def floor_image(scene, half_side, size=2048):
    """The reflectance of a square of the floor around the domain, in the axes of Blender, bottom row first."""
    domain = scene["domain"]
    centre = 0.5 * (np.asarray(domain["min"]) + np.asarray(domain["max"]))
    along = (2 * (np.arange(size, dtype=np.float64) + 0.5) / size - 1) * half_side
    x, north = np.meshgrid((centre[0] + along).astype(F), (-centre[2] + along).astype(F))
    return floor_albedo(x, -north, scene["floor"], 2 * half_side / size)
