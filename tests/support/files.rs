//! The files of the repository, for tests that read sources.

use std::path::{Path, PathBuf};

/// The repository.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The files below a folder whose names end like one of `endings`, leaving out folders of the names `without`, sorted.
pub fn below(folder: &Path, endings: &[&str], without: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            if !without.contains(&name.as_str()) {
                found.append(&mut below(&path, endings, without));
            }
        } else if endings.iter().any(|e| name.ends_with(&format!(".{e}"))) {
            found.push(path);
        }
    }
    found.sort();
    found
}
