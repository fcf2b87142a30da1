//! Tests of files that are replaced atomically, and read within limits.

#![expect(
    clippy::disallowed_methods,
    reason = "the tests look at the files that they wrote"
)]

use dapple_image::{ImageErrorKind, Limits, read_image, replace};
use std::error::Error;
use std::fs;
use std::path::PathBuf;

/// Creates an empty folder for a test.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("dapple-image-{}-{name}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn a_file_is_replaced_and_nothing_is_left_beside_it() {
    let folder = folder("replace");
    let path = folder.join("a.png");
    for content in [b"first".as_slice(), b"second, longer", b"3"] {
        replace(&path, content).unwrap();
        assert_eq!(fs::read(&path).unwrap(), content, "the content");
    }
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "one file");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn the_longest_name_of_a_file_system_can_be_written() {
    let folder = folder("long");
    let path = folder.join(format!("{}.png", "n".repeat(251)));
    replace(&path, b"content").unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"content", "255 bytes");
    fs::remove_dir_all(folder).unwrap();
}

#[cfg(unix)]
#[test]
fn permissions_and_links_are_kept() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = folder("kept");
    let (file, link) = (folder.join("a.png"), folder.join("link.png"));
    fs::write(&file, b"old").unwrap();
    fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
    symlink(&file, &link).unwrap();
    replace(&link, b"new").unwrap();
    assert!(link.is_symlink(), "the link stays");
    assert_eq!(fs::read(&file).unwrap(), b"new", "where it leads to");
    let mode = fs::metadata(&file).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o640, "the permissions stay");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_failed_write_leaves_what_was_there() {
    let folder = folder("failed");
    let taken = folder.join("taken");
    fs::create_dir_all(taken.join("inside")).unwrap();
    for path in [taken.clone(), folder.join("missing").join("a.png")] {
        let error = replace(&path, b"content").unwrap_err();
        assert_eq!(error.kind(), &ImageErrorKind::Io, "{error}");
        assert_eq!(error.path(), Some(path.as_path()), "{error}");
        assert!(error.source().is_some(), "{error}");
    }
    assert!(taken.join("inside").is_dir(), "the folder is untouched");
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "nothing else");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_file_past_the_limit_is_refused() {
    let folder = folder("limit");
    let path = folder.join("ten");
    replace(&path, b"0123456789").unwrap();
    let kind = |bytes| {
        let limits = Limits {
            bytes,
            ..Limits::default()
        };
        let error = read_image(&path, &limits).unwrap_err();
        assert_eq!(error.path(), Some(path.as_path()), "{error}");
        error.kind().clone()
    };
    let read = ImageErrorKind::UnknownFormat;
    assert_eq!(
        kind(10),
        read,
        "exactly the limit: its content is looked at"
    );
    let expected = ImageErrorKind::TooManyBytes {
        bytes: 10,
        limit: 9,
    };
    assert_eq!(kind(9), expected, "one more");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_missing_file_is_an_error_with_a_source() {
    let path = std::env::temp_dir().join("dapple-image-none");
    let error = read_image(path, &Limits::default()).unwrap_err();
    assert_eq!(error.kind(), &ImageErrorKind::Io, "{error}");
    let source = error
        .source()
        .and_then(|source| source.downcast_ref::<std::io::Error>());
    assert_eq!(
        source.map(std::io::Error::kind),
        Some(std::io::ErrorKind::NotFound),
        "{error}"
    );
}
