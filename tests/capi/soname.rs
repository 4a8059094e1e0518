//! A program that is linked with cargo's shared library asks for it by its soname, so a file of that name is beside it.

#[test]
#[cfg(target_os = "linux")]
fn the_library_of_cargo_is_found_by_its_soname() {
    // This test is PROFILE/deps/capi-HASH.
    let test = std::env::current_exe().unwrap();
    let profile = test.ancestors().nth(2).unwrap();
    let (major, minor) = (env!("CARGO_PKG_VERSION_MAJOR"), env!("CARGO_PKG_VERSION_MINOR"));
    let version = if major == "0" { format!("0.{minor}") } else { major.into() };
    let link = profile.join(format!("libstickslip.so.{version}"));
    assert_eq!(std::fs::read_link(&link).expect("a link of build.rs").to_str(), Some("libstickslip.so"), "{link:?}");
}
