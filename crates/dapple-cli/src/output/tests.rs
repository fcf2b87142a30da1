//! Tests that output files appear complete and all at once, and never replace existing files without `--force`.

use super::{OutputIdx, Outputs, Target};
use std::fs;
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Creates an empty directory for a test.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("dapple-cli-{}-{name}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn claim(outputs: &mut Outputs, path: &Path) -> OutputIdx {
    outputs.claim(&Target::from(path)).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = names
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn files_appear_together_at_the_end() {
    let folder = folder("together");
    let [a, b] = ["a", "b"].map(|name| folder.join(name));
    let mut outputs = Outputs::new(false);
    let [first, second] = [&a, &b].map(|path| claim(&mut outputs, path));
    outputs.write(first, b"first").unwrap();
    outputs.write(second, b"second").unwrap();
    assert!(!a.exists() && !b.exists(), "nothing yet");
    outputs.commit().unwrap();
    assert_eq!(fs::read(&a).unwrap(), b"first");
    assert_eq!(fs::read(&b).unwrap(), b"second");
    assert_eq!(names(&folder), ["a", "b"], "and nothing else");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_writer_seeks_and_the_content_is_read_back() {
    let folder = folder("writer");
    let mut outputs = Outputs::new(false);
    let output = claim(&mut outputs, &folder.join("a"));
    let mut writer = outputs.writer(output).unwrap();
    writer.write_all(b"xxxx").unwrap();
    writer.seek(SeekFrom::Start(0)).unwrap();
    writer.write_all(b"ab").unwrap();
    writer.seek(SeekFrom::Start(2)).unwrap();
    writer.write_all(b"c").unwrap();
    writer.flush().unwrap();
    let content = outputs.content(output).unwrap();
    // The checksum of the four bytes "abcx", as printed by `sha256sum`.
    let sha256 = "7571ce1f8e21c6b13dd7ec2c5ec7c9e4dd9852e209869511853f2f1f74b17927";
    assert_eq!((content.bytes, content.sha256.as_str()), (4, sha256));
    outputs.commit().unwrap();
    assert_eq!(fs::read(folder.join("a")).unwrap(), b"abcx");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn what_is_not_committed_goes_with_the_folders_made_for_it() {
    let base = folder("dropped");
    let mut outputs = Outputs::new(false);
    let inner = base.join("new").join("inner");
    outputs.make_folder(&inner).unwrap();
    let output = claim(&mut outputs, &inner.join("a"));
    outputs.write(output, b"half").unwrap();
    assert_eq!(names(&inner).len(), 1, "the temporary file");
    drop(outputs);
    assert_eq!(names(&base), Vec::<String>::new(), "all gone");
    fs::remove_dir_all(base).unwrap();
}

#[test]
fn nothing_is_replaced_unless_forced() {
    let folder = folder("force");
    let path = folder.join("a");
    fs::write(&path, b"old").unwrap();
    let error = Outputs::new(false)
        .claim(&Target::from(path.as_path()))
        .unwrap_err();
    assert!(error.to_string().contains("exists already"), "{error}");
    let mut outputs = Outputs::new(true);
    let output = claim(&mut outputs, &path);
    outputs.write(output, b"new").unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"old", "until the end");
    outputs.commit().unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"new");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_file_that_came_meanwhile_is_kept() {
    let folder = folder("meanwhile");
    let path = folder.join("a");
    let mut outputs = Outputs::new(false);
    let output = claim(&mut outputs, &path);
    outputs.write(output, b"ours").unwrap();
    fs::write(&path, b"theirs").unwrap();
    let error = outputs.commit().unwrap_err();
    assert!(error.to_string().contains("exists already"), "{error}");
    assert_eq!(fs::read(&path).unwrap(), b"theirs");
    assert_eq!(names(&folder), ["a"], "no temporary file is left");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn what_a_dead_process_left_is_taken_away_and_nothing_else_is() {
    let folder = folder("stale");
    for name in [".dapple-a1b2c3.part", ".dapple-a1b2c3", "dapple.part"] {
        fs::write(folder.join(name), b"half").unwrap();
    }
    let mut living = Outputs::new(false);
    claim(&mut living, &folder.join("a"));
    let mut outputs = Outputs::new(false);
    let output = claim(&mut outputs, &folder.join("a"));
    outputs.write(output, b"whole").unwrap();
    outputs.commit().unwrap();
    let kept = names(&folder);
    assert!(
        !kept.contains(&".dapple-a1b2c3.part".to_owned()),
        "{kept:?}"
    );
    // Two files with other names, the temporary file of the run that is still active, and the new file.
    assert_eq!(kept.len(), 4, "{kept:?}");
    drop(living);
    assert_eq!(names(&folder).len(), 3, "it took its own away");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn names_may_be_as_long_as_the_file_system_has_them() {
    let folder = folder("long");
    for length in [244, 255] {
        let path = folder.join("n".repeat(length));
        let mut outputs = Outputs::new(false);
        let output = claim(&mut outputs, &path);
        outputs.write(output, b"whole").unwrap();
        outputs.commit().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"whole", "{length} bytes");
    }
    let path = folder.join("n".repeat(256));
    let error = Outputs::new(false).claim(&Target::from(path.as_path()));
    let error = error.unwrap_err().to_string();
    assert!(
        error.contains("cannot be written"),
        "before the work: {error}"
    );
    assert_eq!(names(&folder).len(), 2, "and nothing else");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn documents_are_placed_after_what_they_name() {
    let folder = folder("documents");
    let names = ["a.json", "a.mtlx", "a.obj", "a.mtl", "a_b.png", "a.gltf"];
    // The commit fails at the file `last`, which has appeared meanwhile. The message lists the files renamed before it.
    let placed = |last: &str| {
        let mut outputs = Outputs::new(false);
        for name in names {
            let output = claim(&mut outputs, &folder.join(name));
            outputs.write(output, b"new").unwrap();
        }
        fs::write(folder.join(last), b"theirs").unwrap();
        let error = format!("{:#}", outputs.commit().unwrap_err());
        for name in names {
            let _ = fs::remove_file(folder.join(name));
        }
        let (_, list) = error.split_once("was written: ").unwrap_or_default();
        let (list, _) = list.split_once(": ").unwrap_or((list, ""));
        let names = list
            .split(", ")
            .map(|path| path.rsplit('/').next().unwrap_or(""));
        names.map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(
        placed("a.json"),
        ["a_b.png", "a.mtl", "a.mtlx", "a.obj", "a.gltf"]
    );
    assert_eq!(placed("a.mtlx"), ["a_b.png", "a.mtl"]);
    fs::remove_dir_all(folder).unwrap();
}

#[cfg(unix)]
#[test]
fn permissions_of_a_replaced_file_are_kept() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder("permissions");
    let path = folder.join("a");
    fs::write(&path, b"old").unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
    let mut outputs = Outputs::new(true);
    let output = claim(&mut outputs, &path);
    outputs.write(output, b"new").unwrap();
    outputs.commit().unwrap();
    let mode = fs::metadata(&path).unwrap().permissions().mode();
    assert_eq!(
        (fs::read(&path).unwrap(), mode & 0o777),
        (b"new".to_vec(), 0o640)
    );
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn folders_missing_folders_and_double_claims_are_refused() {
    let folder = folder("refused");
    let mut outputs = Outputs::new(true);
    let mut refuse = |path: &Path| outputs.claim(&Target::from(path)).unwrap_err().to_string();
    assert!(refuse(&folder).contains("is a folder"), "a folder");
    assert!(
        refuse(&folder.join("no").join("a")).contains("cannot be written"),
        "no folder"
    );
    let path = folder.join("a");
    claim(&mut outputs, &path);
    let error = outputs.claim(&Target::from(path.as_path())).unwrap_err();
    assert!(error.to_string().contains("twice"), "{error}");
    drop(outputs);
    fs::remove_dir_all(folder).unwrap();
}

#[cfg(unix)]
#[test]
fn links_stay_and_devices_are_written_to() {
    let folder = folder("links");
    let (file, link) = (folder.join("file"), folder.join("link"));
    fs::write(&file, b"old").unwrap();
    std::os::unix::fs::symlink(&file, &link).unwrap();
    let mut outputs = Outputs::new(true);
    let output = claim(&mut outputs, &link);
    outputs.write(output, b"new").unwrap();
    let null = claim(&mut outputs, Path::new("/dev/null"));
    outputs.write(null, b"gone").unwrap();
    outputs.commit().unwrap();
    assert!(link.is_symlink(), "the link stays");
    assert_eq!(fs::read(&file).unwrap(), b"new");
    fs::remove_dir_all(folder).unwrap();
}
