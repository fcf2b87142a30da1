//! Tests which files remain after Ctrl-C and after kills.

#![cfg(unix)]

use crate::support::{Folder, assert_done};
use std::fs;
use std::process::{Child, Command};
use std::time::Duration;

/// Command line of a synthesis that takes much longer than the tests.
const LONG: [&str; 9] = [
    "synth",
    "photo.png",
    "--size",
    "4096",
    "--threads",
    "1",
    "--force",
    "-o",
    "out.png",
];
/// Timeout of the tests, in steps of 10 milliseconds. The awaited events should happen at once.
const PATIENCE: usize = 3000;

/// Starts the synthesis, and waits until its temporary file exists.
fn start(folder: &Folder) -> Child {
    let mut child = folder.command(&LONG).spawn().unwrap();
    let is_there = (0..PATIENCE).any(|_| {
        std::thread::sleep(Duration::from_millis(10));
        has_temporary(folder)
    });
    if !is_there {
        child.kill().unwrap();
        panic!("no temporary file came; it ended with {:?}", child.wait());
    }
    child
}

fn has_temporary(folder: &Folder) -> bool {
    folder.names().iter().any(|name| name.ends_with(".part"))
}

fn signal(child: &Child, name: &str) {
    let id = child.id().to_string();
    let status = Command::new("kill").args([name, &id]).status().unwrap();
    assert!(status.success(), "the signal was sent");
}

#[test]
fn interrupts_leave_nothing_and_exit_with_130() {
    for name in ["-INT", "-TERM", "-HUP"] {
        let folder = Folder::with_inputs(&format!("interrupt{name}"));
        fs::write(folder.path("out.png"), b"mine").unwrap();
        let before = folder.names();
        let mut child = start(&folder);
        signal(&child, name);
        assert_eq!(child.wait().unwrap().code(), Some(130), "{name}");
        assert_eq!(folder.names(), before, "{name} leaves nothing");
        assert_eq!(fs::read(folder.path("out.png")).unwrap(), b"mine", "{name}");
    }
}

#[test]
fn a_killed_run_leaves_the_old_file_and_the_next_run_tidies_up() {
    let folder = Folder::with_inputs("kill");
    fs::write(folder.path("out.png"), b"mine").unwrap();
    let mut child = start(&folder);
    signal(&child, "-KILL");
    assert!(!child.wait().unwrap().success(), "it was killed");
    assert!(has_temporary(&folder), "nobody could take it away");
    assert_eq!(fs::read(folder.path("out.png")).unwrap(), b"mine");
    let next = ["tile", "photo.png", "--force", "-o", "out.png"];
    assert_done(&folder.run(&next), "the next run");
    assert!(!has_temporary(&folder), "the next run has taken it away");
}
