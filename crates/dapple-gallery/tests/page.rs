//! Tests the page in a real browser: renders a few figures into a folder and opens the page in headless Chromium.
//!
//! `page/harness.html` operates the page as a reader would and records what it finds; screenshots of the page, light
//! and dark, are checked here. Without a Chromium (on the `PATH`, or named by the variable `CHROMIUM`) the tests print
//! a note and pass.
//!
//! The text of the page is tested here as well: a test in the library would compile all figures again.
#![expect(
    clippy::disallowed_methods,
    reason = "a browser is another program, and reads files"
)]

use dapple_color::LinearRgb;
use dapple_gallery::figures;
use dapple_gallery::page::{Entry, Image, html};
use dapple_image::{Limits, read_image};
use dapple_raster::Raster;
use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

/// Names of Chromium programs on the `PATH`.
const NAMES: [&str; 4] = [
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
];

/// Figures of two papers, with one, two and six images. Some of the images repeat.
const FIGURES: [&str; 6] = [
    "pups-fig-01a",
    "pups-fig-02",
    "pups-fig-03",
    "pups-fig-11",
    "pups-fig-17",
    "worley-fig-01",
];

/// Names of the harness functions that check the page.
const CHECKS: [&str; 8] = [
    "pictures",
    "enlarging",
    "tiling",
    "finding",
    "copying",
    "themes",
    "narrow",
    "withoutScripts",
];

/// Time limit for a browser, in tenths of a second. The first start on a machine takes tens of seconds.
const TENTHS_MAX: u32 = 1800;

#[test]
fn page_names_every_picture_and_loads_nothing_from_elsewhere() {
    let image = |file: String| Image {
        file,
        label: "a < b".into(),
        note: "seam < 1\n".into(),
        repeats: [true, false],
        size: [5, 4],
    };
    let entries: Vec<_> = figures()
        .map(|figure| Entry {
            figure,
            images: vec![image(format!("{}.png", figure.name()))],
        })
        .collect();
    let page = html(&entries, "../../");
    for figure in figures() {
        assert!(
            page.contains(&format!("src=\"{}.png\"", figure.name())),
            "no picture of {}",
            figure.name()
        );
        assert!(
            page.contains(&format!("href=\"../../{}\"", figure.source.path)),
            "no source of {}",
            figure.name()
        );
    }
    assert!(
        page.contains("a &lt; b") && page.contains(">seam &lt; 1</pre>"),
        "label, note or time is missing"
    );
    let shell = html(&[], "");
    for foreign in ["http:", "https:", "\"//", "(//", "@import", "src="] {
        assert!(!shell.contains(foreign), "the page refers to `{foreign}`");
    }
}

#[test]
fn papers_without_figures_have_no_section() {
    assert!(!html(&[], "").contains("<section"), "an empty section");
}

/// Maximum number of attempts to run the checks, which do not always finish.
const TRIALS: usize = 5;

#[test]
fn page_works_in_a_browser() {
    let Some(browser) = browser() else { return };
    let folder = rendered("harness");
    fs::write(
        folder.join("harness.html"),
        include_str!("page/harness.html"),
    )
    .expect("the harness is written");
    let arguments = ["--dump-dom", "--allow-file-access-from-files"];
    let dump = |_| run(&browser, &folder, &arguments, "harness.html");
    // On a machine with much to do the browser's own time may be over before the last check, while it decodes a picture.
    let is_done =
        |dom: &String| dom.contains(": withoutScripts</li>") || dom.contains("<li>failed: ");
    let dom = (0..TRIALS).map(dump).find(is_done);
    let dom = dom.expect("the checks come to their end");
    let lines = |prefix: &str| -> Vec<String> {
        let items = dom.split("<li>").skip(1);
        let items = items.filter_map(|rest| rest.split("</li>").next());
        items
            .filter_map(|item| item.strip_prefix(prefix).map(str::to_owned))
            .collect()
    };
    assert_eq!(lines("failed: "), [""; 0], "what failed");
    assert_eq!(lines("passed: "), CHECKS, "what passed");
}

#[test]
fn page_is_light_or_dark_as_the_system_and_shows_pictures() {
    let Some(browser) = browser() else { return };
    let folder = rendered("looks");
    // `preferredColorScheme` is 0 for dark and 1 for light.
    let light = screenshot(&browser, &folder, 1);
    let dark = screenshot(&browser, &folder, 0);
    for (name, picture) in [("light", &light), ("dark", &dark)] {
        let ground = picture.pixels()[0].luminance();
        assert_eq!(ground > 0.5, name == "light", "{name}: {ground}");
        let codes = picture.pixels().iter().map(|color| color.to_srgb::<u8>());
        let n_colors = codes.collect::<BTreeSet<_>>().len();
        assert!(n_colors > 200, "{name}: {n_colors} colors");
    }
    // The pictures themselves are equal in both schemes.
    let same = light.zip_map(&dark, |a, b| f32::from(a == b));
    let same = same.expect("the same size").statistics().mean;
    assert!(same > 0.1, "{same} of the pixels are the same");
}

/// Returns the path of a Chromium. If there is none, prints a note and returns `None`.
fn browser() -> Option<PathBuf> {
    let found = match std::env::var_os("CHROMIUM") {
        Some(named) => Some(PathBuf::from(named)),
        None => on_path(),
    };
    if found.is_none() {
        // A macro would print to the captured output, which is hidden for a test that passes.
        let mut stderr = std::io::stderr().lock();
        let _ = writeln!(
            stderr,
            "skipped: there is no {} on the PATH, and CHROMIUM names none",
            NAMES.join(", ")
        );
    }
    found
}

fn on_path() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let folders: Vec<_> = std::env::split_paths(&path).collect();
    let candidates = NAMES
        .iter()
        .flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
    // Some systems have a placeholder script of that name, which prints a note and fails.
    let runs = |candidate: &PathBuf| {
        let version = Command::new(candidate).arg("--version").output();
        version.is_ok_and(|version| version.status.success())
    };
    candidates
        .into_iter()
        .find(|candidate| candidate.is_file() && runs(candidate))
}

/// Renders a few figures and their page into a new folder. Returns the folder.
fn rendered(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("page-{name}"));
    if folder.exists() {
        fs::remove_dir_all(&folder).expect("an old folder is removed");
    }
    let gallery = Command::new(env!("CARGO_BIN_EXE_dapple-gallery"))
        .args(["--size", "160", "--out"])
        .arg(&folder)
        .args(FIGURES)
        .output()
        .expect("the gallery runs");
    assert!(gallery.status.success(), "{gallery:?}");
    folder
}

/// Takes a screenshot of the page in the browser.
fn screenshot(browser: &Path, folder: &Path, scheme: u32) -> Raster<LinearRgb> {
    let file = folder.join(format!("screenshot-{scheme}.png"));
    let arguments = [
        format!("--screenshot={}", file.display()),
        format!("--blink-settings=preferredColorScheme={scheme}"),
        "--window-size=800,900".to_owned(),
    ];
    run(
        browser,
        folder,
        &arguments.each_ref().map(String::as_str),
        "index.html",
    );
    let image = read_image(file, &Limits::default()).expect("a screenshot");
    image.color().expect("it is in color")
}

/// Opens a file of the folder in a browser with a new profile. Returns the text that the browser prints.
fn run(browser: &Path, folder: &Path, arguments: &[&str], file: &str) -> String {
    let output = folder.join("output.txt");
    let file = folder.join(file);
    let mut child = Command::new(browser)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--no-first-run",
        ])
        .args(["--hide-scrollbars", "--virtual-time-budget=60000"])
        .arg(format!(
            "--user-data-dir={}",
            folder.join("profile").display()
        ))
        .args(arguments)
        .arg(format!("file://{}", file.display()))
        .stdout(fs::File::create(&output).expect("a file for the output"))
        .stderr(Stdio::null())
        .spawn()
        .expect("the browser starts");
    for _ in 0..TENTHS_MAX {
        if let Some(status) = child.try_wait().expect("the browser can be waited for") {
            assert!(status.success(), "the browser failed: {status}");
            return fs::read_to_string(output).expect("the output is text");
        }
        sleep(Duration::from_millis(100));
    }
    child.kill().expect("the browser is stopped");
    panic!("the browser took longer than {} s", TENTHS_MAX / 10);
}
