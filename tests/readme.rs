//! The README's C program compiles as printed and prints what the README says.

mod support;

use std::path::Path;
use std::process::Command;
use support::c::*;

#[test]
fn snippet_prints_what_the_readme_says() {
    let readme = include_str!("../README.md");
    let code = readme.split("```c\n").nth(1).unwrap().split("```").next().unwrap();
    let printed = readme.split("it prints `").nth(1).unwrap().split('`').next().unwrap();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let (source, program) = (folder.join("readme.c"), folder.join("readme"));
    std::fs::write(&source, code).unwrap();
    let mut command = compiler(false);
    command.args(["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-I"]).arg(include()).arg("-o");
    run(
        command.args([&program, &source]).arg(library("libstickslip.a")).args(SYSTEM_LIBRARIES),
        "the README's program",
    );
    assert_eq!(run(&mut Command::new(&program), "the README's program").trim(), printed);
}
