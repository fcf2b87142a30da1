//! Rules about crates: their folders, their dependencies, their lints and their packages.

use super::workspace::Workspace;

/// Checks that each crate is in the folder `crates/<name>`. Only `tests` and `xtask` may be at the root.
pub(super) fn folders(workspace: &Workspace) -> Vec<String> {
    let misplaced = workspace.members.iter().filter(|member| {
        let rooted = ["tests", "xtask"].contains(&member.folder.as_str());
        !rooted && member.folder != format!("crates/{}", member.name)
    });
    misplaced
        .map(|member| {
            format!(
                "{}: the folder of `{}` has another name",
                member.folder, member.name
            )
        })
        .collect()
}

/// Checks that every crate has a layer, and that its dependencies in the workspace have strictly lower layers.
/// Dev-dependencies are exempt.
pub(super) fn layers(workspace: &Workspace) -> Vec<String> {
    let mut found = Vec::new();
    for member in &workspace.members {
        let Some(layer) = workspace.layers.get(&member.name) else {
            found.push(format!(
                "Cargo.toml: [workspace.metadata.layers] lacks `{}`",
                member.name
            ));
            continue;
        };
        for used in &member.dependencies {
            if let Some(below) = workspace.layers.get(used).filter(|below| *below >= layer) {
                let name = &member.name;
                found.push(format!(
                    "{}/Cargo.toml: `{name}` of layer {layer} uses `{used}` of layer {below}",
                    member.folder
                ));
            }
        }
    }
    let is_member = |name: &String| workspace.members.iter().any(|member| member.name == *name);
    let gone = workspace.layers.keys().filter(|name| !is_member(name));
    found.extend(gone.map(|name| {
        format!("Cargo.toml: [workspace.metadata.layers] names `{name}`, which is no member")
    }));
    found
}

/// Checks that `xtask` uses no crate of the workspace, which keeps its build short, and that no crate uses `xtask`.
pub(super) fn xtask_alone(workspace: &Workspace) -> Vec<String> {
    let is_member = |name: &String| workspace.members.iter().any(|member| member.name == *name);
    let mut found = Vec::new();
    for member in &workspace.members {
        let ours = member.dependencies.iter().filter(|name| is_member(name));
        let wrong = ours.filter(|used| member.name == "xtask" || *used == "xtask");
        found.extend(wrong.map(|used| {
            format!(
                "{}/Cargo.toml: `{}` uses `{used}`",
                member.folder, member.name
            )
        }));
    }
    found
}

/// Checks that every crate has `[lints] workspace = true`. Without it, a crate silently has no lints at all.
pub(super) fn lints(workspace: &Workspace) -> Vec<String> {
    let without = workspace.members.iter().filter(|member| {
        let mut lines = member.manifest.lines().map(str::trim);
        let section = lines.any(|line| line == "[lints]");
        !section || lines.find(|line| !line.is_empty()) != Some("workspace = true")
    });
    without
        .map(|member| {
            format!(
                "{}/Cargo.toml: no `[lints] workspace = true`",
                member.folder
            )
        })
        .collect()
}

/// Checks that every published package has keywords and categories, documentation of all features, the license texts
/// and a README.
pub(super) fn packages(workspace: &Workspace) -> Vec<String> {
    let mut found = Vec::new();
    for member in workspace.members.iter().filter(|member| member.published) {
        let folder = &member.folder;
        let lines = ["keywords = [", "categories = [", "all-features = true"];
        let has = |start: &str| member.manifest.lines().any(|line| line.starts_with(start));
        let missing = lines.into_iter().filter(|start| !has(start));
        found.extend(missing.map(|start| format!("{folder}/Cargo.toml: no line `{start}`")));
        let files = ["LICENSE-APACHE", "LICENSE-MIT", "README.md"];
        let missing = files
            .into_iter()
            .filter(|file| !member.files.iter().any(|there| there == file));
        found.extend(missing.map(|file| format!("{folder}/{file} is missing")));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::{folders, layers, lints, packages, xtask_alone};
    use crate::tidy::workspace::{Member, Workspace};

    fn member(name: &str, folder: &str, dependencies: &[&str]) -> Member {
        Member {
            name: name.into(),
            folder: folder.into(),
            manifest: "[lints]\nworkspace = true\n".into(),
            dependencies: dependencies.iter().map(ToString::to_string).collect(),
            ..Member::default()
        }
    }

    fn workspace(members: Vec<Member>, layers: &[(&str, u64)]) -> Workspace {
        let layers = layers
            .iter()
            .map(|(name, layer)| (name.to_string(), *layer));
        Workspace {
            members,
            layers: layers.collect(),
            ..Workspace::default()
        }
    }

    #[test]
    fn folders_fires_on_another_name() {
        let broken = workspace(
            vec![
                member("dapple-a", "crates/a", &[]),
                member("dapple-tests", "tests", &[]),
            ],
            &[],
        );
        assert_eq!(
            folders(&broken),
            ["crates/a: the folder of `dapple-a` has another name"]
        );
    }

    #[test]
    fn layers_fires_on_the_same_and_on_a_higher_layer() {
        let members = vec![
            member("a", "crates/a", &["b", "c", "glam"]),
            member("b", "crates/b", &[]),
            member("c", "crates/c", &[]),
        ];
        let sound = workspace(members.clone(), &[("a", 2), ("b", 1), ("c", 0)]);
        assert!(layers(&sound).is_empty(), "a sound workspace is refused");
        let broken = workspace(members, &[("a", 1), ("b", 1), ("c", 2)]);
        let expected = ["b` of layer 1", "c` of layer 2"]
            .map(|used| format!("crates/a/Cargo.toml: `a` of layer 1 uses `{used}"));
        assert_eq!(layers(&broken), expected);
    }

    #[test]
    fn layers_fires_on_a_crate_without_a_layer_and_on_a_layer_without_a_crate() {
        let broken = workspace(vec![member("a", "crates/a", &[])], &[("b", 0)]);
        let expected = ["lacks `a`", "names `b`, which is no member"]
            .map(|what| format!("Cargo.toml: [workspace.metadata.layers] {what}"));
        assert_eq!(layers(&broken), expected);
    }

    #[test]
    fn xtask_alone_fires_in_both_directions() {
        let broken = workspace(
            vec![
                member("a", "crates/a", &["xtask"]),
                member("xtask", "xtask", &["a", "lexopt"]),
            ],
            &[],
        );
        let expected = [
            "crates/a/Cargo.toml: `a` uses `xtask`",
            "xtask/Cargo.toml: `xtask` uses `a`",
        ];
        assert_eq!(xtask_alone(&broken), expected);
    }

    #[test]
    fn lints_fires_on_a_manifest_without_them() {
        for manifest in [
            "[package]\n",
            "[lints]\n[dependencies]\n",
            "[lints.rust]\nworkspace = true\n",
        ] {
            let member = Member {
                manifest: manifest.into(),
                ..member("a", "crates/a", &[])
            };
            assert_eq!(
                lints(&workspace(vec![member], &[])).len(),
                1,
                "`{manifest}` passes"
            );
        }
        assert!(
            lints(&workspace(vec![member("a", "crates/a", &[])], &[])).is_empty(),
            "a sound manifest is refused"
        );
    }

    #[test]
    fn packages_fires_on_what_a_registry_would_miss() {
        let mut published = member("dapple-a", "crates/dapple-a", &[]);
        published.published = true;
        published.manifest =
            "keywords = []\n[package.metadata.docs.rs]\nall-features = true\n".into();
        published.files = vec!["LICENSE-MIT".into(), "README.md".into()];
        let expected = [
            "crates/dapple-a/Cargo.toml: no line `categories = [`",
            "crates/dapple-a/LICENSE-APACHE is missing",
        ];
        let unpublished = member("dapple-b", "crates/dapple-b", &[]);
        let broken = workspace(vec![published, unpublished], &[]);
        assert_eq!(packages(&broken), expected);
    }
}
