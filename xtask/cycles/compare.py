"""Compares pictures with those of Cycles: `compare.py FOLDER PAIRS NAME ...`.

FOLDER contains NAME.png, drawn by Splashdown, and NAME.npy, the light of Cycles. Writes PAIRS/NAME.jpg with both side by
side, and prints a row of numbers per name as JSON.
"""

import json
import sys
from pathlib import Path

import flip_evaluator
import numpy as np
from PIL import Image
from skimage.metrics import structural_similarity

# As in globals.wgsl.
EXPOSURE = 0.80


def shown(light):
    """The tone curve of globals.wgsl and the encoding of sRGB."""
    x = np.maximum(light * EXPOSURE, 0)
    linear = np.clip(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)


def luma(picture):
    """Brightness of every pixel, from 0 to 1 (Rec. 709 on encoded colours)."""
    return picture @ np.array([0.2126, 0.7152, 0.0722], picture.dtype)


def compare(folder, pairs, name):
    with Image.open(folder / f"{name}.png") as file:
        ours = np.asarray(file.convert("RGB"), np.float32) / 255
    cycles = shown(np.load(folder / f"{name}.npy")).astype(np.float32)
    if ours.shape != cycles.shape:
        raise SystemExit(f"{name}: the pictures have the shapes {ours.shape} and {cycles.shape}")
    (a, b) = (luma(ours), luma(cycles))
    _, flip, _ = flip_evaluator.evaluate(cycles, ours, "LDR", applyMagma=False, computeMeanError=True)
    height, width = a.shape
    pair = Image.new("RGB", (2 * width + 4, height), "white")
    for place, picture in ((0, ours), (width + 4, cycles)):
        pair.paste(Image.fromarray((picture * 255 + 0.5).astype(np.uint8)), (place, 0))
    pair.save(pairs / f"{name}.jpg", quality=86, optimize=True)
    return {
        "name": name,
        "brightness": [float(a.mean()), float(b.mean())],
        "contrast": [float(a.std()), float(b.std())],
        "ssim": float(structural_similarity(a, b, data_range=1.0, gaussian_weights=True, sigma=1.5)),
        "flip": float(flip),
    }


def main():
    folder, pairs, *names = sys.argv[1:]
    pairs = Path(pairs)
    pairs.mkdir(parents=True, exist_ok=True)
    print(json.dumps([compare(Path(folder), pairs, name) for name in names]))


if __name__ == "__main__":
    main()
