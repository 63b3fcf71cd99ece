//! PNG files, compared with the reader and the writer of the crate `image`.

#![cfg(feature = "png")]

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use splashdown_io::Picture;
use splashdown_io::picture::{decode_png, read_png, write_png, write_png_to};

const SIZE: [u32; 2] = [7, 5];

fn pattern(channels: usize) -> Vec<u8> {
    (0..SIZE[0] as usize * SIZE[1] as usize * channels).map(|i| (37 * i % 251) as u8).collect()
}

fn by_image(data: &[u8], colour: ExtendedColorType) -> Vec<u8> {
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Adaptive)
        .write_image(data, SIZE[0], SIZE[1], colour)
        .unwrap();
    bytes
}

#[test]
fn bytes_equal_those_of_the_other_writer() {
    let picture = Picture { width: SIZE[0], height: SIZE[1], rgba: pattern(4) };
    let mut bytes = Vec::new();
    write_png_to(&mut bytes, &picture).unwrap();
    assert_eq!(bytes, by_image(&picture.rgba, ExtendedColorType::Rgba8));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    assert_eq!(write_png(&path, &picture).unwrap(), bytes.len() as u64);
    assert_eq!(std::fs::read(&path).unwrap(), bytes);
    assert_eq!(read_png(&path).unwrap(), picture);
}

#[test]
fn every_colour_type_becomes_rgba() {
    let types = [
        (ExtendedColorType::L8, 1),
        (ExtendedColorType::La8, 2),
        (ExtendedColorType::Rgb8, 3),
        (ExtendedColorType::Rgba8, 4),
    ];
    for (colour, channels) in types {
        let bytes = by_image(&pattern(channels), colour);
        let expected = image::load_from_memory(&bytes).unwrap().into_rgba8().into_raw();
        let picture = decode_png(&bytes).unwrap();
        assert_eq!([picture.width, picture.height], SIZE);
        assert_eq!(picture.rgba, expected, "{colour:?}");
    }
}

#[test]
fn sixteen_bit_channels_keep_their_upper_byte() {
    let data: Vec<u8> =
        pattern(3).into_iter().flat_map(|value| u16::from_be_bytes([value, 9]).to_ne_bytes()).collect();
    let picture = decode_png(&by_image(&data, ExtendedColorType::Rgb16)).unwrap();
    let expected: Vec<u8> = pattern(3).chunks(3).flat_map(|rgb| [rgb[0], rgb[1], rgb[2], 255]).collect();
    assert_eq!(picture.rgba, expected);
}

#[test]
fn damaged_files_and_wrong_sizes_are_errors() {
    let bytes = by_image(&pattern(4), ExtendedColorType::Rgba8);
    assert!(decode_png(&bytes[..bytes.len() / 2]).is_err());
    assert!(decode_png(b"no picture").is_err());
    let short = Picture { width: 2, height: 2, rgba: vec![0; 15] };
    assert!(write_png_to(&mut Vec::new(), &short).is_err());
}
