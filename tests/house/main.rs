//! The order of the house, read from its files: arrows between modules, rooms of the driver, citations, the header as a
//! reference, pages that are short, keys of scenes.

#[path = "../support/mod.rs"]
mod support;

mod citations;
mod driver_rooms;
mod keys;
mod layers;
mod links;
mod pages;
mod reference;
