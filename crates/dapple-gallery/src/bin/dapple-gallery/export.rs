//! Writes the images as PNG files, and the page next to them.
#![expect(clippy::disallowed_methods, reason = "files are written here")]

use crate::{draw_each, root};
use anyhow::{Context, ensure};
use dapple_gallery::page::{self, Entry, Image};
use dapple_gallery::{Figure, Panel, Picture};
use dapple_image::{Depth, write_color_png, write_gray_png};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Renders `figures` into the folder `out`. Returns the path of the page.
pub(crate) fn export(
    figures: &[&'static Figure],
    size: u32,
    out: &Path,
) -> anyhow::Result<PathBuf> {
    fs::create_dir_all(out).with_context(|| format!("cannot make the folder {}", out.display()))?;
    let entries = draw_each(figures, |figure| export_figure(figure, size, out))?;
    let page = out.join("index.html");
    let html = page::html(&entries, &relative_root(out)?);
    fs::write(&page, html).with_context(|| format!("cannot write {}", page.display()))?;
    Ok(page)
}

fn export_figure(figure: &'static Figure, size: u32, out: &Path) -> anyhow::Result<Entry> {
    let panels = figure.render(size)?;
    let mut images = Vec::new();
    for (number, panel) in (1..).zip(&panels) {
        let file = match panels.len() {
            1 => format!("{}.png", figure.name()),
            _ => format!("{}-{number}.png", figure.name()),
        };
        write_png(&out.join(&file), panel)?;
        images.push(Image {
            file,
            label: panel.label.clone(),
            note: panel.note.clone(),
            repeats: panel.repeats,
            size: panel.size(),
        });
    }
    Ok(Entry { figure, images })
}

fn write_png(path: &Path, panel: &Panel) -> anyhow::Result<()> {
    match &panel.picture {
        Picture::Gray(raster) => write_gray_png(path, raster, Depth::Eight),
        Picture::Color(raster) => write_color_png(path, raster, Depth::Eight),
    }
    .with_context(|| format!("cannot write {}", path.display()))
}

/// Returns the relative path from the folder `out` to the root of the workspace, as used in links: `../../`.
fn relative_root(out: &Path) -> anyhow::Result<String> {
    let [out, root] = [out, root()].map(|path| {
        path.canonicalize()
            .with_context(|| format!("cannot find {}", path.display()))
    });
    let (out, root) = (out?, root?);
    let shared = out
        .components()
        .zip(root.components())
        .take_while(|(a, b)| a == b)
        .count();
    let up = "../".repeat(out.components().count() - shared);
    let down = root
        .components()
        .skip(shared)
        .map(|part| format!("{}/", part.as_os_str().to_string_lossy()));
    Ok(up + &down.collect::<String>())
}

/// Opens a page with the system's default program.
pub(crate) fn open(page: &Path) -> anyhow::Result<()> {
    let opener = match std::env::consts::OS {
        "windows" => "explorer",
        "macos" => "open",
        _ => "xdg-open",
    };
    let status = Command::new(opener).arg(page).status();
    let status =
        status.with_context(|| format!("cannot run `{opener}` to open {}", page.display()))?;
    // `explorer` reports failure even when it opened the page.
    ensure!(
        status.success() || opener == "explorer",
        "`{opener}` could not open {}",
        page.display()
    );
    Ok(())
}
