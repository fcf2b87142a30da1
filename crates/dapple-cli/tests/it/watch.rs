//! Tests of `dapple watch`, which bakes again at every save.

use crate::support::Folder;
use dapple::image::{Limits, read_image};
use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// Time limit for the bake after a save. It takes a few tenths of a second, and more if other tests run.
const DEADLINE: Duration = Duration::from_secs(60);

/// Returns the text of a recipe with a constant height.
fn flat(height: &str) -> String {
    format!("dapple = 1\n\n[material]\nheight = {height}\n")
}

/// The running command. The process is killed on drop.
struct Watching(Child);

impl Drop for Watching {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Returns whether a file is an image of this size in which all pixels have this gray value.
fn holds(path: &Path, size: [u32; 2], gray: f32) -> bool {
    let Ok(image) = read_image(path, &Limits::default()) else {
        return false;
    };
    // Half a step of 16 bits.
    let is_near = |value: &f32| (value - gray).abs() < 0.5 / 65535.0;
    image.size() == size
        && image
            .gray()
            .is_ok_and(|image| image.pixels().iter().all(is_near))
}

/// Waits for an image in which all pixels have this gray value. After the time limit, fails with the image that was
/// found instead.
#[expect(clippy::disallowed_methods, reason = "another program is waited for")]
fn wait_for(watching: &mut Watching, path: &Path, gray: f32, what: &str) {
    let start = Instant::now();
    while !holds(path, [300, 200], gray) {
        let ended = watching.0.try_wait().unwrap();
        assert!(ended.is_none(), "{what}: it ended: {ended:?}");
        let found = read_image(path, &Limits::default()).map(|image| {
            let first = image.gray().map(|gray| gray.pixels()[0]);
            (image.size(), first)
        });
        assert!(
            start.elapsed() < DEADLINE,
            "{what}: after {DEADLINE:?}, {} is not 300 × 200 pixels of {gray}, but {found:?}",
            path.display()
        );
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn every_save_is_baked_and_a_mistake_leaves_the_files() {
    let folder = Folder::new("watch");
    let (recipe, height) = (folder.path("own.toml"), folder.path("out/own_height.png"));
    fs::write(&recipe, flat("0.25")).unwrap();
    let words = [
        "watch", "own.toml", "-o", "out/", "--size", "300x200", "--maps", "height", "--quiet",
    ];
    let child = folder
        .command(&words)
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut watching = Watching(child);
    wait_for(&mut watching, &height, 0.25, "the first bake");

    fs::write(&recipe, flat("0.5")).unwrap();
    wait_for(&mut watching, &height, 0.5, "a save");

    // A program that writes to another file and renames it.
    fs::write(&recipe, "height = what").unwrap();
    fs::write(folder.path("aside"), flat("0.75")).unwrap();
    fs::rename(folder.path("aside"), &recipe).unwrap();
    wait_for(&mut watching, &height, 0.75, "a save after a mistake");
}

#[test]
#[cfg(unix)]
fn saves_through_links_are_baked_while_another_file_changes_all_the_time() {
    use std::sync::atomic::{AtomicBool, Ordering};
    let folder = Folder::new("watch-link");
    let path = |name: &str| folder.path(name);
    fs::create_dir(path("real")).unwrap();
    for name in ["real/a.toml", "real/b.toml"] {
        fs::write(path(name), flat("0.25")).unwrap();
    }
    let link = |to: &str| {
        let _ = fs::remove_file(path("own.toml"));
        std::os::unix::fs::symlink(to, path("own.toml")).unwrap();
    };
    link("real/a.toml");
    let words = [
        "watch", "own.toml", "-o", "out/", "--size", "300x200", "--maps", "height", "--quiet",
    ];
    let child = folder
        .command(&words)
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut watching = Watching(child);
    let height = path("out/own_height.png");
    let is_over = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            while !is_over.load(Ordering::SeqCst) {
                fs::write(path("log.txt"), "more").unwrap();
                std::thread::sleep(Duration::from_millis(10));
            }
        });
        wait_for(&mut watching, &height, 0.25, "the first bake");
        fs::write(path("real/a.toml"), flat("0.5")).unwrap();
        wait_for(&mut watching, &height, 0.5, "a save in place");
        fs::write(path("real/aside"), flat("0.75")).unwrap();
        fs::rename(path("real/aside"), path("real/a.toml")).unwrap();
        wait_for(&mut watching, &height, 0.75, "a save by renaming");
        link("real/b.toml");
        wait_for(&mut watching, &height, 0.25, "a link that leads elsewhere");
        fs::write(path("real/b.toml"), flat("0.125")).unwrap();
        wait_for(&mut watching, &height, 0.125, "a save where it leads then");
        is_over.store(true, Ordering::SeqCst);
    });
}
