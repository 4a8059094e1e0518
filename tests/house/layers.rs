//! The direction of dependencies (ARCHITECTURE.md): leaf mathematics knows no contact, the law knows no integration, only
//! `capi` and `simd` are unsafe; no circles among files; stages are called in one order, and know no handle.

use crate::support::files::{below, root};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// Modules and what each may import, lowest first.
const ALLOWED: [(&str, &[&str]); 19] = [
    ("error", &[]),
    ("features", &["error"]),
    ("memory", &["error"]),
    ("adjacency", &["error", "memory"]),
    ("threads", &["error", "memory"]),
    ("simd", &[]),
    ("shape", &["error", "simd"]),
    ("quadrature", &["error"]),
    ("geometry", &["error", "shape", "simd"]),
    ("normal", &["error", "geometry"]),
    ("rigid", &["error", "geometry", "memory"]),
    ("mortar", &["error", "features", "geometry", "quadrature", "shape", "simd"]),
    ("line", &["error", "features", "geometry", "mortar", "quadrature", "shape", "simd"]),
    ("dual", &["error", "geometry", "mortar", "shape", "simd"]),
    ("points", &["geometry", "mortar", "quadrature", "shape"]),
    ("law", &["error", "geometry", "memory"]),
    ("element", &["dual", "error", "geometry", "law", "mortar", "quadrature", "shape", "simd"]),
    (
        "interface",
        &[
            "adjacency",
            "dual",
            "element",
            "error",
            "features",
            "geometry",
            "law",
            "line",
            "memory",
            "mortar",
            "normal",
            "points",
            "quadrature",
            "shape",
            "simd",
            "threads",
        ],
    ),
    ("skin", &["adjacency", "error", "geometry", "interface", "law", "line", "memory", "mortar"]),
];

fn sources(module: &str) -> Vec<PathBuf> {
    let file = root().join(format!("src/{module}.rs"));
    if file.exists() { vec![file] } else { below(&root().join("src").join(module), &["rs"], &[]) }
}

/// Top-level modules named after `crate::` in a file.
fn imports(text: &str) -> impl Iterator<Item = &str> {
    text.split("crate::")
        .skip(1)
        .map(|rest| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or(""))
}

#[test]
fn imports_point_downward() {
    for (module, allowed) in ALLOWED {
        for file in sources(module) {
            let text = std::fs::read_to_string(&file).unwrap();
            for import in imports(&text) {
                let fine = import == module || allowed.contains(&import);
                assert!(fine, "{}: crate::{import} is not below {module}", file.display());
            }
        }
    }
}

#[test]
fn only_the_abi_and_the_processors_instructions_are_unsafe() {
    for (module, _) in ALLOWED {
        for file in sources(module) {
            let text = std::fs::read_to_string(&file).unwrap();
            for word in ["unsafe ", "libc::", "*const ", "*mut "] {
                let may_be_unsafe = module == "simd" && word == "unsafe ";
                assert!(may_be_unsafe || !text.contains(word), "{} contains '{word}'", file.display());
            }
        }
    }
}

/// The stages of an evaluation, in their order: none calls an earlier one, though it may know what that gives.
const STAGES: [&str; 5] = ["integrate", "facet", "sums", "respond", "residual"];

/// The rooms of `src/interface`, lowest first.
const ROOMS: [&str; 11] = [
    "compose",
    "data",
    "pairing",
    "stages",
    "tangent",
    "weights",
    "heat",
    "sensitivity",
    "plan",
    "condensed",
    "inspect",
];

/// Files that know the handle: itself, and those that give it to hosts.
const KNOW_THE_HANDLE: [&str; 12] = [
    "interface/condensation.rs",
    "interface/contact.rs",
    "interface/evaluation.rs",
    "interface/layer.rs",
    "interface/linearisation.rs",
    "interface/mod.rs",
    "interface/offsets.rs",
    "interface/own.rs",
    "interface/sensitive.rs",
    "interface/thermal.rs",
    "interface/turning.rs",
    "capi/",
];

/// The modules of a file below src: `interface/mod.rs` is `interface`.
fn module_of(file: &str) -> Vec<String> {
    let path = file.trim_end_matches(".rs").trim_end_matches("/mod");
    path.split('/').map(str::to_owned).collect()
}

/// The paths of a tree after `use`: `a::{b, c::d}` is `a::b` and `a::c::d`.
fn expanded(tree: &str) -> Vec<String> {
    let tree = tree.trim();
    let Some((before, rest)) = tree.split_once('{') else {
        return vec![tree.split(" as ").next().unwrap().trim().to_owned()];
    };
    let inner = rest.rsplit_once('}').map_or(rest, |(inner, _)| inner);
    let (mut depth, mut part, mut parts) = (0, String::new(), Vec::new());
    for c in inner.chars() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        if c == ',' && depth == 0 {
            parts.push(std::mem::take(&mut part));
        } else {
            part.push(c);
        }
    }
    parts.push(part);
    let parts = parts.iter().filter(|part| !part.trim().is_empty());
    parts.flat_map(|part| expanded(part)).map(|path| format!("{before}{path}")).collect()
}

/// All paths that a file names from `crate`, `super` or one of its own modules on, tests apart.
fn paths(text: &str) -> Vec<Vec<String>> {
    let code = text.split("#[cfg(test)]").next().unwrap();
    let code: String = code.lines().map(|l| l.split("//").next().unwrap().to_owned() + "\n").collect();
    let mut found = Vec::new();
    for statement in code.split(';') {
        let line = statement.trim_start_matches(|c: char| c.is_whitespace() || c == '}');
        let line = line.rsplit("\n\n").next().unwrap().trim();
        let used = line.strip_prefix("pub use ").or_else(|| line.strip_prefix("use "));
        match used.or_else(|| line.split_once(") use ").map(|(_, used)| used)) {
            Some(tree) => found.extend(expanded(tree)),
            None => {
                for root in ["crate::", "super::"] {
                    for (at, _) in statement.match_indices(root) {
                        let path = &statement[at..];
                        let end =
                            path.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':')).unwrap_or(path.len());
                        found.push(path[..end].to_owned());
                    }
                }
            }
        }
    }
    found.iter().map(|path| path.split("::").map(|n| n.trim().to_owned()).filter(|n| n != "self").collect()).collect()
}

/// Per file of src the files that it imports.
fn graph() -> BTreeMap<String, BTreeSet<String>> {
    let src = root().join("src");
    let files: Vec<String> = below(&src, &["rs"], &[])
        .iter()
        .map(|f| f.strip_prefix(&src).unwrap().to_string_lossy().replace('\\', "/"))
        .filter(|f| !["lib.rs", "mortar/oracle.rs", "interface/by_hand.rs"].contains(&f.as_str())) // tests, the latter two
        .collect();
    let by_module: BTreeMap<Vec<String>, &String> = files.iter().map(|f| (module_of(f), f)).collect();
    let mut graph = BTreeMap::new();
    for file in &files {
        let text = std::fs::read_to_string(src.join(file)).unwrap();
        let mut imports = BTreeSet::new();
        for path in paths(&text) {
            let supers = path.iter().take_while(|n| *n == "super").count();
            let (mut module, rest) = match path.first().map(String::as_str) {
                Some("crate") => (Vec::new(), &path[1..]),
                Some("super") => {
                    let own = module_of(file);
                    (own[..own.len() - supers].to_vec(), &path[supers..])
                }
                _ => (module_of(file), &path[..]),
            };
            let from = module.len();
            for name in rest {
                module.push(name.clone());
                if !by_module.contains_key(&module) {
                    module.pop();
                    break;
                }
            }
            let relative = !matches!(path.first().map(String::as_str), Some("crate" | "super"));
            if let Some(target) = by_module.get(&module).filter(|t| **t != file && !(relative && module.len() == from))
            {
                imports.insert((*target).clone());
            }
        }
        graph.insert(file.clone(), imports);
    }
    graph
}

/// A way from a file back to itself.
fn circle(graph: &BTreeMap<String, BTreeSet<String>>) -> Option<Vec<String>> {
    /// 1: on the way, 2: done.
    fn visit(
        file: &String,
        graph: &BTreeMap<String, BTreeSet<String>>,
        state: &mut BTreeMap<String, u8>,
        way: &mut Vec<String>,
    ) -> bool {
        match state.get(file) {
            Some(1) => {
                way.push(file.clone());
                return true;
            }
            Some(_) => return false,
            None => {}
        }
        state.insert(file.clone(), 1);
        way.push(file.clone());
        if graph[file].iter().any(|next| visit(next, graph, state, way)) {
            return true;
        }
        way.pop();
        state.insert(file.clone(), 2);
        false
    }
    let (mut state, mut way) = (BTreeMap::new(), Vec::new());
    graph.keys().any(|file| visit(file, graph, &mut state, &mut way)).then_some(way)
}

#[test]
fn no_file_imports_itself_by_a_detour() {
    let graph = graph();
    let imports: usize = graph.values().map(BTreeSet::len).sum();
    assert!(graph.len() > 80 && imports > 300, "{} files, {imports} imports", graph.len());
    assert!(graph["interface/contact.rs"].contains("interface/cache.rs"), "else nothing is seen");
    if let Some(way) = circle(&graph) {
        panic!("a circle: {}", way.join(" -> "));
    }
}

#[test]
fn rooms_of_the_interface_point_downward() {
    let room = |file: &str| {
        let name = file.strip_prefix("interface/")?.split_once('/')?.0;
        Some(ROOMS.iter().position(|room| *room == name).unwrap_or_else(|| panic!("{file} is in no room")))
    };
    for (file, imports) in graph() {
        let Some(own) = room(&file) else { continue };
        for import in imports {
            assert!(room(&import).is_none_or(|other| other <= own), "{file} imports {import}, which is above it");
            assert!(import != "interface/mod.rs", "{file} imports the house that it stands in");
        }
    }
}

#[test]
fn a_planted_circle_is_found() {
    let mut graph = graph();
    graph.get_mut("interface/data/history.rs").unwrap().insert("interface/stages/commit.rs".to_owned());
    assert!(circle(&graph).is_some());
}

#[test]
fn no_stage_calls_an_earlier_one() {
    for (k, stage) in STAGES.iter().enumerate() {
        let text = std::fs::read_to_string(root().join(format!("src/interface/stages/{stage}.rs"))).unwrap();
        for path in paths(&text) {
            let [.., module, name] = &path[..] else { continue };
            let is_earlier = STAGES[..k].contains(&module.as_str()) && path[0] == "super";
            let is_function = name.starts_with(char::is_lowercase);
            assert!(!(is_earlier && is_function), "{stage}.rs imports {module}::{name}");
        }
    }
}

#[test]
fn no_function_outside_the_handle_takes_it() {
    let src = root().join("src");
    for file in below(&src, &["rs"], &[]) {
        let name = file.strip_prefix(&src).unwrap().to_string_lossy().replace('\\', "/");
        let code = std::fs::read_to_string(&file).unwrap();
        let code = code.lines().filter(|l| !l.trim_start().starts_with("//")).any(|l| l.contains("Contact<"));
        assert!(!code || KNOW_THE_HANDLE.iter().any(|f| name.starts_with(f)), "{name} knows the handle");
    }
}
