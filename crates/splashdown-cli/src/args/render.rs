//! Options of `render`.

use std::path::PathBuf;

use clap::Args;
use splashdown::scene::{ColourBy, Output, PictureKind, PictureQuality};

use super::{choice, limit, whole};

const EXAMPLES: &str = "\
Examples:
  splashdown render out/dam-break
  splashdown render out/dam-break --quality final --frames 40 -o still
  splashdown render out/my --scene my.toml --frames 20..80 --turn 90 --size 1920x1080
  splashdown render out/my --frames 100.. --slow 4 --loop 3
  splashdown render out/my --pictures particles --colour-by pressure
  splashdown render out/my --camera-path flight.toml

Reads the meshes or particles and the spray, foam and bubbles of the run, and writes numbered PNG
pictures and, with ffmpeg and several pictures, a film. Isolated particles, which are not part of the
meshes, are drawn as droplets if the run has particle files.

Frames that are missing or cannot be read are left out, and damaged files beside them are not drawn.
Each problem is reported once, at the end, and the exit code is 0 if there is a picture. Ctrl-C ends
the film with the pictures so far.

A slow film shows pictures between the frames: liquid, droplets and foam of the nearest frame are moved
by their velocities, and bodies and camera are where they are at that time.";

/// Options of `render`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct RenderArguments {
    /// Output folder of a run with meshes
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
    /// Scene file or built-in scene to draw with [default: the scene of the run, as it was]
    #[arg(long, value_name = "SCENE")]
    pub scene: Option<PathBuf>,
    /// Folder of the pictures and the film; numbered if it exists [default: RUN/render]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// A frame, or the first and the last frame, which may be left out: 3, 20..80, 20.., ..80 [default: all]
    #[arg(short, long, value_name = "N|A..B", value_parser = frames)]
    pub frames: Option<FrameRange>,
    /// What is drawn [default: the surface if the run has meshes]
    #[arg(long, value_name = "WHAT", value_parser = choice::<PictureKind>())]
    pub pictures: Option<PictureKind>,
    /// Quantity that colours the particles [default: the scene's]
    #[arg(long, value_name = "QUANTITY", value_parser = choice::<ColourBy>())]
    pub colour_by: Option<ColourBy>,
    /// How carefully pictures are drawn
    #[arg(long, value_name = "QUALITY", value_parser = choice::<PictureQuality>(), default_value = "standard")]
    pub quality: PictureQuality,
    /// Particles in blobs of fewer than N are drawn as droplets; 0: only those of the run's droplet files
    /// [default: the scene's]
    #[arg(long, value_name = "N", value_parser = limit())]
    pub min_blob: Option<u32>,
    /// Particles with fewer than N others within 0.9 support radii are drawn as droplets; 0: only those of the run's
    /// droplet files [default: the scene's]
    #[arg(long, value_name = "N", value_parser = limit())]
    pub min_neighbours: Option<u32>,
    /// Width and height in pixels, even; at most 32768 each, 268 million in all, and 8192 each with a film
    /// [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = picture_size)]
    pub size: Option<[u32; 2]>,
    /// Degrees added to the camera's azimuth
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, default_value_t = 0.0, value_parser = degrees)]
    pub azimuth: f32,
    /// Degrees that the camera turns around the target from the first to the last picture
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, default_value_t = 0.0, value_parser = degrees)]
    pub turn: f32,
    /// Elevation of the camera in degrees [default: the scene's]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    pub elevation: Option<f32>,
    /// Factor on the camera's distance
    #[arg(long, value_name = "F", default_value_t = 1.0, value_parser = factor)]
    pub distance: f32,
    /// TOML file with the path of the camera: sections [[keyframe]], as [[camera.keyframe]] of a scene
    #[arg(long, value_name = "FILE")]
    pub camera_path: Option<PathBuf>,
    /// Slow motion: number of pictures per frame; below 1 the film plays faster
    #[arg(long, value_name = "F", default_value_t = 1.0, value_parser = factor)]
    pub slow: f32,
    /// Measure the time of every pass and print it at the end; drawing is slower
    #[arg(long)]
    pub timing: bool,
    /// How often the film shows the pictures
    #[arg(long = "loop", value_name = "N", default_value_t = 1, value_parser = whole(1..=1000))]
    pub repeat: u32,
}

/// The frames to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRange {
    /// The first one.
    pub first: u32,
    /// The last one; `None`: the last of the run.
    pub last: Option<u32>,
}

fn frames(text: &str) -> Result<FrameRange, String> {
    let number = |text: &str| text.parse::<u32>().ok();
    let range = match text.split_once("..") {
        Some(("", last)) => number(last).map(|last| FrameRange { first: 0, last: Some(last) }),
        Some((first, "")) => number(first).map(|first| FrameRange { first, last: None }),
        Some((first, last)) => {
            number(first).zip(number(last)).map(|(first, last)| FrameRange { first, last: Some(last) })
        }
        None => number(text).map(|frame| FrameRange { first: frame, last: Some(frame) }),
    };
    range.filter(|range| range.last.is_none_or(|last| range.first <= last)).ok_or_else(|| {
        "frames are a number, or two increasing numbers with two dots between them, one of which may be left out, such as \
         20..80 or 20.."
            .to_owned()
    })
}

fn picture_size(text: &str) -> Result<[u32; 2], String> {
    let side =
        |side: &str| side.parse().ok().filter(|side| (16..=Output::MAX_SIDE).contains(side) && side % 2 == 0);
    let size = match text.split_once('x').map(|(width, height)| (side(width), side(height))) {
        Some((Some(width), Some(height))) => [width, height],
        _ => {
            return Err(
                "a size is two even integers from 16 to 32768 with an x between them, such as 1920x1080"
                    .to_owned(),
            );
        }
    };
    match Output::can_have_size(size) {
        true => Ok(size),
        false => Err("a picture has at most 268 million pixels, such as 16384x16384".to_owned()),
    }
}

fn degrees(text: &str) -> Result<f32, String> {
    let number = text.parse().ok().filter(|number: &f32| number.abs() <= 36_000.0);
    number.ok_or_else(|| "an angle is a number of degrees from -36000 to 36000".to_owned())
}

fn factor(text: &str) -> Result<f32, String> {
    let factor = text.parse().ok().filter(|factor| (0.01..=100.0).contains(factor));
    factor.ok_or_else(|| "a factor is a number from 0.01 to 100".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_even_and_limited() {
        assert_eq!(picture_size("12000x8000"), Ok([12_000, 8000]));
        assert_eq!(picture_size("32768x8192"), Ok([32_768, 8192]));
        for wrong in ["", "640", "641x480", "14x16", "32770x16"] {
            assert!(picture_size(wrong).unwrap_err().contains("from 16 to 32768"), "{wrong}");
        }
        assert!(picture_size("32768x8194").unwrap_err().contains("268 million"));
    }

    #[test]
    fn frames_are_a_number_or_an_increasing_range() {
        let range = |first, last| Ok(FrameRange { first, last });
        assert_eq!(frames("7"), range(7, Some(7)));
        assert_eq!(frames("20..80"), range(20, Some(80)));
        assert_eq!(frames("3.."), range(3, None));
        assert_eq!(frames("..3"), range(0, Some(3)));
        for wrong in ["", "8..2", "a", "..", "1..b", "-1"] {
            assert!(frames(wrong).is_err(), "{wrong}");
        }
    }
}
