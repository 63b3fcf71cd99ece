//! A Debian package: an `ar` archive with the format version, the control files and the data (deb(5)).

use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use flate2::{Compression, GzBuilder};

use super::{Release, archive::write_gzipped_tar, read, stage::StagedFile, target::Target};

/// Writes the package, and returns its path.
pub fn write(release: &Release, target: &Target, binary: &Path, stage: &[StagedFile]) -> Result<PathBuf> {
    let architecture = architecture(target)?;
    let files = layout(stage)?;
    let libc = newest_glibc(&read(binary)?).context("the binary names no version of glibc")?;
    let kilobytes = files.iter().map(|file| file.bytes.len().div_ceil(1024)).sum::<usize>();
    let control = control(&release.version, architecture, &libc, kilobytes);
    let control = [StagedFile::new("control", control)];
    let mut package = b"!<arch>\n".to_vec();
    append(&mut package, "debian-binary", b"2.0\n", release.time)?;
    append(&mut package, "control.tar.gz", &tar_of(&control, release.time)?, release.time)?;
    append(&mut package, "data.tar.gz", &tar_of(&files, release.time)?, release.time)?;
    let path = release.folder.join(format!("splashdown_{}-1_{architecture}.deb", release.version));
    fs::write(&path, package).with_context(|| format!("cannot write {}", path.display()))?;
    Ok(path)
}

/// Debian's name of the processor architecture.
fn architecture(target: &Target) -> Result<&'static str> {
    let processor = target.triple.split('-').next().unwrap_or_default();
    match processor {
        "x86_64" => Ok("amd64"),
        "aarch64" => Ok("arm64"),
        other => anyhow::bail!("Debian packages for {other} are not supported"),
    }
}

/// The files of the archive at the paths that Debian requires.
fn layout(stage: &[StagedFile]) -> Result<Vec<StagedFile>> {
    let mut files = Vec::new();
    for file in stage {
        let bytes = || file.bytes.clone();
        let doc = "usr/share/doc/splashdown";
        let (path, bytes) = match file.path.as_str() {
            "splashdown" => ("usr/bin/splashdown".to_owned(), bytes()),
            "LICENSE-MIT" | "LICENSE-APACHE" => continue,
            "CHANGELOG.md" => (format!("{doc}/changelog.gz"), gzip(&file.bytes)?),
            "THIRD-PARTY.txt" => (format!("{doc}/THIRD-PARTY.txt.gz"), gzip(&file.bytes)?),
            "man/splashdown.1" => ("usr/share/man/man1/splashdown.1.gz".to_owned(), gzip(&file.bytes)?),
            "completions/splashdown.bash" => {
                ("usr/share/bash-completion/completions/splashdown".to_owned(), bytes())
            }
            "completions/_splashdown" => ("usr/share/zsh/vendor-completions/_splashdown".to_owned(), bytes()),
            "completions/splashdown.fish" => {
                ("usr/share/fish/vendor_completions.d/splashdown.fish".to_owned(), bytes())
            }
            path if path.starts_with("completions/") => continue,
            path => match path.strip_prefix("scenes/") {
                Some(scene) => (format!("{doc}/examples/{scene}"), bytes()),
                None => (format!("{doc}/{path}"), bytes()),
            },
        };
        files.push(StagedFile { path, bytes, executable: file.executable });
    }
    let licence = |name: &str| {
        let file = stage.iter().find(|file| file.path == name);
        file.map(|file| String::from_utf8_lossy(&file.bytes).into_owned()).context("a licence is missing")
    };
    let copyright = format!(
        "Splashdown is licensed under the MIT licence or the Apache licence 2.0, at your option. The packages that\n\
         it contains and their licences are listed in THIRD-PARTY.txt.gz.\n\n{}\n\n{}",
        licence("LICENSE-MIT")?,
        licence("LICENSE-APACHE")?
    );
    files.push(StagedFile::new("usr/share/doc/splashdown/copyright", copyright));
    files.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(files)
}

/// The control file. The libraries of the window, the Vulkan driver and `ffmpeg` are loaded at run time and optional.
fn control(version: &str, architecture: &str, libc: &str, kilobytes: usize) -> String {
    format!(
        "Package: splashdown\n\
         Version: {version}-1\n\
         Architecture: {architecture}\n\
         Maintainer: {}\n\
         Installed-Size: {kilobytes}\n\
         Depends: libc6 (>= {libc}), libgcc-s1\n\
         Recommends: libvulkan1, mesa-vulkan-drivers, ffmpeg\n\
         Suggests: libwayland-client0, libx11-xcb1, libxcursor1, libxi6, libxkbcommon-x11-0, libxrandr2\n\
         Section: science\n\
         Priority: optional\n\
         Homepage: {}\n\
         Description: fluid simulation with smoothed-particle hydrodynamics\n \
         Splashdown reads a scene file and writes particles, a watertight mesh per frame,\n \
         pictures and a film. It computes on any GPU with a Vulkan driver, or on the CPU.\n",
        env!("CARGO_PKG_AUTHORS"),
        env!("CARGO_PKG_REPOSITORY"),
    )
}

/// The newest version of glibc that a binary requires, from symbol versions such as `GLIBC_2.34`.
fn newest_glibc(binary: &[u8]) -> Option<String> {
    let mark = b"GLIBC_";
    let mut versions = BTreeSet::new();
    for (at, _) in binary.windows(mark.len()).enumerate().filter(|(_, window)| window == mark) {
        let digits =
            binary[at + mark.len()..].iter().take_while(|byte| byte.is_ascii_digit() || **byte == b'.');
        let text: String = digits.map(|byte| char::from(*byte)).collect();
        let numbers: Option<Vec<u32>> = text.split('.').map(|number| number.parse().ok()).collect();
        versions.extend(numbers);
    }
    let newest = versions.pop_last()?;
    Some(newest.iter().map(u32::to_string).collect::<Vec<_>>().join("."))
}

fn tar_of(files: &[StagedFile], time: u64) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let entries = files.iter().map(|file| (format!("./{}", file.path), file));
    write_gzipped_tar(&mut bytes, entries, time)?;
    Ok(bytes)
}

fn gzip(bytes: &[u8]) -> Result<Vec<u8>> {
    let mut gzip = GzBuilder::new().mtime(0).write(Vec::new(), Compression::best());
    gzip.write_all(bytes)?;
    Ok(gzip.finish()?)
}

/// Appends a member to an `ar` archive: a header of 60 bytes, the content, and padding to an even length.
fn append(archive: &mut Vec<u8>, name: &str, content: &[u8], time: u64) -> Result<()> {
    writeln!(archive, "{name:<16}{time:<12}{:<6}{:<6}{:<8}{:<10}`", 0, 0, "100644", content.len())?;
    archive.extend_from_slice(content);
    if content.len() % 2 == 1 {
        archive.push(b'\n');
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{append, newest_glibc};

    #[test]
    fn glibc_versions_are_compared_as_numbers() {
        let binary = b"\0GLIBC_2.9\0GLIBC_2.34\0GLIBC_2.2.5\0GLIBC_PRIVATE\0";
        assert_eq!(newest_glibc(binary).as_deref(), Some("2.34"));
        assert_eq!(newest_glibc(b"static"), None);
    }

    #[test]
    fn members_of_an_ar_archive_have_an_even_length() -> anyhow::Result<()> {
        let mut archive = Vec::new();
        append(&mut archive, "debian-binary", b"2.0", 0)?;
        assert_eq!(archive.len(), 60 + 4);
        assert_eq!(&archive[58..], b"`\n2.0\n");
        Ok(())
    }
}
