//! No memory is taken in a way that ends the program where there is none (`src/memory.rs`): the sources are looked
//! through for the standard library's ways, line by line, tests apart.

use crate::support::files::{below, root};

/// What asks for memory and aborts. Of what a line holds, the last words before it decide.
const INFALLIBLE: [&str; 34] = [
    "vec!",
    "format!",
    "with_capacity",
    ".to_vec()",
    ".to_string()",
    ".to_owned()",
    ".to_uppercase()",
    ".collect(",
    ".collect::<",
    ".push(",
    ".push_str(",
    ".extend(",
    ".extend_from_slice(",
    ".append(&mut ",
    ".insert(",
    ".resize(",
    ".resize_with(",
    ".reserve(",
    ".reserve_exact(",
    ".repeat(",
    ".shrink_to_fit()",
    ".concat()",
    ".join(",
    ".sort()",
    ".sort_by(",
    ".sort_by_key(",
    ".clone()",
    ".clone_from(",
    ".unzip()",
    "Box::new",
    "Rc::new",
    "Arc::new",
    "HashMap",
    "BTreeMap",
];

/// Lines that are none of that: file, what the line holds, why.
const HARMLESS: [(&str, &str, &str); 10] = [
    ("capi/guard.rs", "set_hook(Box::new(|info|", "a closure that holds nothing"),
    ("interface/stages/commit.rs", "active.insert(", "into an Option"),
    ("interface/pairing/filter.rs", "smooth.clone()", "an iterator"),
    ("interface/stages/over.rs", "polygon.clone()", "a stack of a fixed size"),
    ("interface/stages/point_parts.rs", "of_facet.clone()", "a range"),
    ("interface/tangent/point_friction.rs", "of_points.clone()", "an iterator"),
    ("interface/tangent/blocks.rs", "sink.reserve(", "a sink keeps its refusal for who asked for the entries"),
    ("interface/pairing/search.rs", "pending.push(", "a stack of a fixed size"),
    ("threads.rs", "thread.join()", "waits for a thread"),
    ("skin/roles.rs", "colours.join(", "two groups become one in place"),
];

/// Folders and files whose stacks have a fixed size, and which know no vectors at all.
const WITHOUT_VECTORS: [&str; 9] =
    ["dual", "element", "geometry", "law", "mortar", "normal.rs", "quadrature", "shape", "simd"];
/// But for tables of a host, which are kept as they were given.
const TABLES: [&str; 1] = ["law/overclosure.rs"];

fn takes_no_memory(file: &str) -> bool {
    !TABLES.contains(&file) && WITHOUT_VECTORS.iter().any(|f| file.starts_with(f))
}

/// The lines of code of every file, tests and comments apart: (file below src, number, line).
fn code() -> Vec<(String, usize, String)> {
    let src = root().join("src");
    let mut lines = Vec::new();
    for file in below(&src, &["rs"], &[]) {
        let text = std::fs::read_to_string(&file).unwrap();
        let name = file.strip_prefix(&src).unwrap().to_string_lossy().replace('\\', "/");
        if text.contains("#![cfg(test)]") || ["mortar/oracle.rs", "interface/by_hand.rs"].contains(&name.as_str()) {
            continue;
        }
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap();
        for (k, line) in code.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//")) {
            lines.push((name.clone(), k + 1, line.split(" // ").next().unwrap().to_string()));
        }
    }
    lines
}

#[test]
fn every_vector_that_grows_may_be_refused() {
    let mut wrong = Vec::new();
    for (file, number, line) in code() {
        if file == "memory.rs" || file == "error.rs" || takes_no_memory(&file) {
            continue;
        }
        let harmless = HARMLESS.iter().any(|(f, part, _)| *f == file && line.contains(part));
        if !harmless && let Some(word) = INFALLIBLE.iter().find(|word| line.contains(*word)) {
            wrong.push(format!("src/{file}:{number}: `{word}` in `{}`", line.trim()));
        }
    }
    assert!(wrong.is_empty(), "use what src/memory.rs has in place of these:\n{}", wrong.join("\n"));
}

/// What lets all calls run out of memory, in foreign floating-point environments and on measured stacks knows all of them.
#[test]
fn every_function_of_the_abi_is_among_those_that_are_tried() {
    let tests = root().join("tests/capi");
    let read = |file: &str| std::fs::read_to_string(tests.join(file)).unwrap();
    let tried = read("every_call.h") + &read("calls.h");
    let mut functions = 0;
    for (file, number, line) in code() {
        let Some((_, rest)) = line.split_once("unsafe extern \"C\" fn ") else { continue };
        let name = rest.split('(').next().unwrap();
        let refusals = read("every_call.h").matches(&format!("return {name}(NULL")).count();
        let special = [
            "stickslip_facet_geometry",
            "stickslip_facet_normal",
            "stickslip_facet_normal_derivatives",
            "stickslip_facet_dual",
            "stickslip_crosspoints_find",
            "stickslip_interface_destroy",
            "stickslip_rigid_create",
            "stickslip_rigid_destroy",
            "stickslip_skin_destroy",
        ];
        assert!(tried.contains(&format!("{name}(")), "src/{file}:{number}: no call of {name} in every_call.h");
        assert!(refusals > 0 || special.contains(&name), "src/{file}:{number}: no refusal of {name} in every_call.h");
        functions += 1;
    }
    assert!(functions > 30, "{functions} functions found");
}

#[test]
fn the_mathematics_below_the_interface_takes_no_memory() {
    for (file, number, line) in code() {
        if takes_no_memory(&file) {
            let word = ["Vec<", "Vec::", "vec!", "String", "Box", "collect()"].into_iter().find(|w| line.contains(w));
            assert!(word.is_none(), "src/{file}:{number}: `{}` in `{}`", word.unwrap(), line.trim());
        }
    }
}
