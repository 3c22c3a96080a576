//! Arrows between rooms, and between crates, are those that ARCHITECTURE.md allows.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

type Arrows = BTreeMap<String, BTreeSet<String>>;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The first and the last cell of each row of the table whose head starts with `| {kind} |`.
fn allowed(kind: &str) -> (Vec<String>, Arrows) {
    let text = fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    let head = format!("| {kind} |");
    let rows = text.lines().skip_while(|line| !line.starts_with(&head)).skip(2);
    let mut order = Vec::new();
    let mut arrows = Arrows::new();
    for row in rows.take_while(|line| line.starts_with('|')) {
        let cells: Vec<&str> = row.split('|').collect();
        let names = |cell: &str| -> Vec<String> {
            cell.split('`').skip(1).step_by(2).map(str::to_owned).collect()
        };
        let name = names(cells[1]).remove(0);
        arrows.insert(name.clone(), names(cells[3]).into_iter().collect());
        order.push(name);
    }
    assert!(!order.is_empty(), "no table of {kind}s in ARCHITECTURE.md");
    (order, arrows)
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
    found
}

/// What a source file names after `crate::`, braces opened.
fn uses(text: &str) -> BTreeSet<String> {
    let code: String = text
        .lines()
        .take_while(|line| !line.contains("#[cfg(test)]"))
        .map(|line| line.split("//").next().unwrap_or_default())
        .collect::<Vec<_>>()
        .join(" ");
    let word = |text: &str| -> String {
        text.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
    };
    let mut found = BTreeSet::new();
    for tail in code.split("crate::").skip(1) {
        let Some(group) = tail.strip_prefix('{') else {
            found.insert(word(tail));
            continue;
        };
        let mut depth = 0;
        let mut item = String::new();
        for c in group.chars() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    found.insert(word(&item));
                    item.clear();
                    continue;
                }
                _ => {}
            }
            item.push(c);
        }
        found.insert(word(&item));
    }
    found
}

#[test]
fn rooms_use_only_the_rooms_their_row_names() {
    let (order, allowed) = allowed("room");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    // Names of the crate's front door that belong to a room.
    let alias = |name: &str| if name == "Error" { "error".to_owned() } else { name.to_owned() };
    for (position, room) in order.iter().enumerate() {
        for above in &allowed[room] {
            let place = order.iter().position(|name| name == above);
            assert!(place.is_some_and(|p| p < position), "{room} may not use {above} below it");
        }
    }
    for path in sources(&folder) {
        let inside = path.strip_prefix(&folder).unwrap();
        let room = inside.iter().next().unwrap().to_string_lossy().replace(".rs", "");
        if room == "lib" {
            continue;
        }
        let Some(may) = allowed.get(&room) else {
            panic!("the room {room} is missing from ARCHITECTURE.md");
        };
        for used in uses(&fs::read_to_string(&path).unwrap()).iter().map(|name| alias(name)) {
            assert!(
                used == room || may.contains(&used),
                "{}: {room} uses {used}, which ARCHITECTURE.md does not allow",
                inside.display()
            );
        }
    }
}

#[test]
fn crates_use_only_the_crates_their_row_names() {
    let (order, allowed) = allowed("crate");
    for name in &order {
        let manifest = root().join("crates").join(name).join("Cargo.toml");
        let text = fs::read_to_string(&manifest).unwrap();
        let normal = text.split("[dev-dependencies]").next().unwrap_or_default();
        let normal = normal.split_once("[dependencies]").map_or("", |(_, rest)| rest);
        for line in normal.lines() {
            let Some(dependency) = line.split(['.', ' ', '=']).next() else { continue };
            if dependency.starts_with("gimfit") {
                assert!(
                    allowed[name].contains(dependency),
                    "{name} uses {dependency}, which ARCHITECTURE.md does not allow"
                );
            }
        }
    }
    let folders = fs::read_dir(root().join("crates")).unwrap().count();
    assert_eq!(folders, order.len(), "every crate has its row in ARCHITECTURE.md");
}

#[test]
fn the_reader_of_arrows_reads_braces() {
    let text = "use crate::{Error, points::{A, B}, memory};\nuse crate::knots::X; // crate::fit\n";
    let found: Vec<String> = uses(text).into_iter().collect();
    assert_eq!(found, ["Error", "knots", "memory", "points"]);
}
