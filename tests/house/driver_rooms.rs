//! The driver, the program of `program`, in rooms: headers do not include each other in a circle, files do not call each
//! other in a circle, and each room includes and calls only what lies below it (program/README.md).

use crate::support::files::{below, root};
use std::collections::{BTreeMap, BTreeSet};

const DRIVER: &str = "program";
/// Lowest first. Files beside the folders stand above all rooms.
const ROOMS: [&str; 7] = ["scene", "mesh", "physics", "contact", "solve", "heat", "output"];

/// Path within the driver -> text.
type Files = BTreeMap<String, String>;
/// File -> files that it needs, each with the reason.
type Graph = BTreeMap<String, BTreeMap<String, String>>;

fn driver() -> Files {
    let folder = root().join(DRIVER);
    let name = |path: &std::path::Path| path.strip_prefix(&folder).unwrap().to_string_lossy().replace('\\', "/");
    let files = below(&folder, &["c", "h"], &["tests"]);
    files.iter().map(|f| (name(f), std::fs::read_to_string(f).unwrap())).collect()
}

/// C without comments and texts.
fn code(text: &str) -> String {
    let (mut found, mut rest) = (String::new(), text);
    while let Some(at) = rest.find(['/', '"', '\'']) {
        found += &rest[..at];
        rest = &rest[at..];
        let length = if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with('/') {
            found.push('/');
            1
        } else {
            quoted(rest)
        };
        rest = &rest[length..];
    }
    found + rest
}

/// The length of the quotation that a text begins with.
fn quoted(text: &str) -> usize {
    let (mark, mut escaped) = (text.chars().next().unwrap(), false);
    for (at, c) in text.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            _ if c == mark => return at + 1,
            _ => {}
        }
    }
    text.len()
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|w| !w.is_empty())
}

/// Functions that other files can call: `name(...)` before a brace on a line of its own, not static, outside all braces.
fn defined(code: &str) -> Vec<String> {
    let (mut found, mut depth, mut head) = (Vec::new(), 0, String::new());
    for line in code.lines().filter(|l| !l.starts_with('#')) {
        if depth == 0 && line == "{" && head.trim_end().ends_with(')') && !head.contains("static ") {
            found.extend(head.split('(').next().and_then(|h| words(h).last()).map(str::to_owned));
        }
        depth += line.matches('{').count() as i32 - line.matches('}').count() as i32;
        let ends = depth == 0 && (line.trim_end().ends_with([';', '}']) || line.trim().is_empty());
        head = if depth > 0 || ends { String::new() } else { head + line + " " };
    }
    found
}

fn includes(files: &Files) -> Graph {
    let of = |text: &str| {
        let named = text.lines().filter_map(|l| l.strip_prefix("#include \"")?.split('"').next());
        named.map(|n| (n.to_owned(), format!("includes {n}"))).collect()
    };
    files.iter().map(|(name, text)| (name.clone(), of(text))).collect()
}

/// Function -> the file that defines it.
fn definitions(codes: &Files) -> BTreeMap<String, String> {
    let sources = codes.iter().filter(|(name, _)| name.ends_with(".c"));
    sources.flat_map(|(name, code)| defined(code).into_iter().map(|f| (f, name.clone()))).collect()
}

fn calls(files: &Files) -> Graph {
    let codes: Files = files.iter().map(|(name, text)| (name.clone(), code(text))).collect();
    let homes = definitions(&codes);
    let mut graph = Graph::new();
    for (name, code) in codes.iter().filter(|(name, _)| name.ends_with(".c")) {
        for word in words(code) {
            if let Some(home) = homes.get(word).filter(|home| *home != name) {
                graph.entry(name.clone()).or_default().insert(home.clone(), format!("calls {word}()"));
            }
        }
    }
    graph
}

/// A circle, as "a calls f(), b calls g(), ...".
fn circle(graph: &Graph) -> Option<String> {
    fn walk(graph: &Graph, at: &str, path: &mut Vec<String>, done: &mut BTreeSet<String>) -> Option<String> {
        if let Some(first) = path.iter().position(|p| p == at) {
            let ring: Vec<&String> = path[first..].iter().collect();
            let next = |k: usize| ring.get(k + 1).map_or(at, |n| n.as_str());
            let told = ring.iter().enumerate().map(|(k, file)| format!("{file} {}", graph[*file][next(k)]));
            return Some(told.collect::<Vec<_>>().join(", "));
        }
        if done.contains(at) {
            return None;
        }
        path.push(at.to_owned());
        let found = graph.get(at).and_then(|next| next.keys().find_map(|n| walk(graph, n, path, done)));
        path.pop();
        done.insert(at.to_owned());
        found
    }
    let mut done = BTreeSet::new();
    graph.keys().find_map(|file| walk(graph, file, &mut Vec::new(), &mut done))
}

/// How high a file's room lies.
fn height(file: &str) -> usize {
    let Some((room, _)) = file.split_once('/') else { return ROOMS.len() };
    ROOMS.iter().position(|r| *r == room).unwrap_or_else(|| panic!("{file}: '{room}' is no room"))
}

/// What is wrong with the rooms, a sentence each.
fn faults(files: &Files) -> Vec<String> {
    let (included, called) = (includes(files), calls(files));
    let mut found = Vec::new();
    for (file, needed) in included.iter().chain(&called) {
        for (other, reason) in needed {
            if !files.contains_key(other) {
                found.push(format!("{file} {reason}, which is not there"));
            } else if height(other) > height(file) {
                found.push(format!("{file} {reason}: {other} is in a higher room"));
            }
        }
    }
    found.extend(circle(&included).map(|c| format!("circle of headers: {c}")));
    found.extend(circle(&called).map(|c| format!("circle of files: {c}")));
    found
}

#[test]
fn rooms_point_one_way_and_nothing_goes_in_circles() {
    let found = faults(&driver());
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn each_room_has_a_header_of_its_own() {
    let files = driver();
    for room in ROOMS {
        assert!(files.contains_key(&format!("{room}/{room}.h")), "{room}");
    }
}

/// A parser that missed most functions or calls would find no circle.
#[test]
fn the_parser_sees_the_driver() {
    let files = driver();
    let codes: Files = files.iter().map(|(name, text)| (name.clone(), code(text))).collect();
    let (homes, called) = (definitions(&codes), calls(&files));
    assert!(files.len() > 40 && homes.len() > 150, "{} files, {} functions", files.len(), homes.len());
    assert!(called.values().map(BTreeMap::len).sum::<usize>() > 120);
    assert_eq!(homes["main"], "main.c");
    assert_eq!(homes["scene_fail"], "scene/scene.c");
    assert!(called["solve/newton.c"]["solve/solver.c"].starts_with("calls solver_"));
}

/// The driver with some text added to some of its files.
fn spoilt(added: &[(&str, &str)]) -> String {
    let mut files = driver();
    for (name, text) in added {
        files.get_mut(*name).unwrap().push_str(text);
    }
    faults(&files).join("\n")
}

#[test]
fn planted_faults_are_found() {
    let circle = spoilt(&[("solve/solver.c", "\nvoid planted(void)\n{\n  (void)newton_solve;\n}\n")]);
    assert!(circle.contains("circle of files") && circle.contains("calls newton_solve()"), "{circle}");
    let headers =
        spoilt(&[("mesh/cell.h", "#include \"mesh/mesh.h\"\n"), ("mesh/mesh.h", "#include \"mesh/cell.h\"\n")]);
    assert!(
        headers.contains("circle of headers: ") && headers.contains("mesh/cell.h includes mesh/mesh.h"),
        "{headers}"
    );
    let upward = spoilt(&[("mesh/box.c", "#include \"contact/contact.h\"\n")]);
    assert!(
        upward.contains("mesh/box.c includes contact/contact.h: contact/contact.h is in a higher room"),
        "{upward}"
    );
    let called = spoilt(&[("contact/reach.c", "\nvoid planted(void)\n{\n  held_create(0);\n}\n")]);
    assert!(called.contains("contact/reach.c calls held_create(): solve/held.c is in a higher room"), "{called}");
    let lost = spoilt(&[("main.c", "#include \"model/model.h\"\n")]);
    assert!(lost.contains("main.c includes model/model.h, which is not there"), "{lost}");
    let words = spoilt(&[("scene/scene.c", "/* newton_solve() */ static const char *t = \"newton_solve(\\\"\";\n")]);
    assert!(words.is_empty(), "comments and texts call nothing: {words}");
}
