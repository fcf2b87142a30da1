//! Tests the order in which files are flushed and renamed, from the system calls of the command. A power failure may
//! happen after any of them.

#![cfg(target_os = "linux")]

use crate::support::{Folder, assert_done};
use std::fs;
use std::process::Command;

/// A system call on a file or directory. Its name is without the parent directories.
#[derive(Debug, PartialEq, Eq)]
enum Call {
    /// Flushes the bytes of a file, or the names in a directory, to disk.
    Sync(String),
    /// Renames a temporary file to its final name.
    Rename(String),
}

/// Runs the command under `strace`, and returns its calls; `None` if processes cannot be traced.
fn trace(folder: &Folder, line: &str) -> Option<Vec<Call>> {
    let log = folder.path("trace.log");
    let traced = Command::new("strace")
        .args(["-f", "-y", "-s", "4096", "-o"])
        .arg(&log)
        .args([
            "-e",
            "trace=fsync,fdatasync,rename,renameat,renameat2,link,linkat",
        ])
        .arg(env!("CARGO_BIN_EXE_dapple"))
        .args(line.split(' '))
        .current_dir(folder.path("."))
        .output();
    let text = fs::read_to_string(&log).unwrap_or_default();
    let _ = fs::remove_file(&log);
    let Ok(output) = traced.map_err(|error| eprintln!("skipped: no strace: {error}")) else {
        return None;
    };
    if !text.contains("exited with") {
        eprintln!(
            "skipped: strace cannot trace: {}",
            String::from_utf8_lossy(&output.stderr)
        );
        return None;
    }
    assert_done(&output, line);
    Some(text.lines().filter_map(call).collect())
}

/// Parses a line of the log, `PID NAME(…) = 0`; `None` for other and failed calls.
fn call(line: &str) -> Option<Call> {
    let (_, call) = line.split_once(' ')?;
    let call = call.trim_start();
    if !call.trim_end().ends_with("= 0") {
        return None;
    }
    let name = |path: &str| {
        path.trim_end_matches('/')
            .rsplit('/')
            .next()
            .map(str::to_owned)
    };
    if call.starts_with("fsync(") || call.starts_with("fdatasync(") {
        // With -y the log has the path of a handle: fsync(5</tmp/a.png>).
        let (_, path) = call.split_once('<')?;
        return name(path.split_once('>')?.0).map(Call::Sync);
    }
    // The last text in quotes is the new name.
    let path = call.rsplit('"').nth(1)?;
    name(path).map(Call::Rename)
}

/// Checks that each file is flushed before it is renamed, and its directory after that.
fn check_order(calls: &[Call], folder: &str, files: &[&str]) {
    let is_part = |call: &Call| matches!(call, Call::Sync(name) if name.starts_with(".dapple-"));
    let n_flushed = calls.iter().filter(|call| is_part(call)).count();
    assert!(n_flushed >= files.len(), "each is flushed: {calls:?}");
    for file in files {
        let renamed = Call::Rename((*file).to_owned());
        let at = calls.iter().position(|call| *call == renamed);
        let at = at.unwrap_or_else(|| panic!("{file} is renamed: {calls:?}"));
        let later = &calls[at..];
        assert!(
            !later.iter().any(is_part),
            "all are flushed before {file}: {calls:?}"
        );
        let of_folder = Call::Sync(folder.to_owned());
        assert!(
            later.contains(&of_folder),
            "{folder} is flushed after {file}: {calls:?}"
        );
    }
}

#[test]
fn outputs_are_on_the_disk_before_they_get_their_names_and_folders_after() {
    let folder = Folder::new("durable");
    let line = "bake flagstone --size 16 --maps height,normal -o new/";
    let Some(calls) = trace(&folder, line) else {
        return;
    };
    let files = ["flagstone_height.png", "flagstone_normal.png"];
    check_order(&calls, "new", &files);
    let parent = folder.path(".").canonicalize().unwrap();
    let parent = parent.file_name().unwrap().to_string_lossy().into_owned();
    assert!(
        calls.contains(&Call::Sync(parent)),
        "the folder was made: {calls:?}"
    );
    let calls = trace(&folder, &format!("{line} --force")).unwrap_or_default();
    check_order(&calls, "new", &files);
}

#[test]
fn a_document_is_named_when_what_it_names_is_on_the_disk() {
    let folder = Folder::new("durable-document");
    let Some(calls) = trace(&folder, "bake flagstone --size 16 -o m/a.mtlx") else {
        return;
    };
    let is_rename = |call: &Call| matches!(call, Call::Rename(_));
    let last = calls.iter().rposition(is_rename).unwrap();
    assert_eq!(calls[last], Call::Rename("a.mtlx".to_owned()), "{calls:?}");
    let before = &calls[..last];
    let image = before.iter().rposition(is_rename).unwrap();
    let of_folder = Call::Sync("m".to_owned());
    assert!(
        before[image..].contains(&of_folder),
        "names of images first: {calls:?}"
    );
}

#[test]
fn the_list_of_shards_is_on_the_disk() {
    let folder = Folder::new("durable-shards");
    let line = "shards flagstone --size 32 --shard 16 --maps height -o parts";
    if let Some(calls) = trace(&folder, line) {
        check_order(&calls, "parts", &["shards.json"]);
    }
}
