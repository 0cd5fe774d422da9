//! Cases: exact solutions, and the scene and study files that name them.
//!
//! ```
//! use tissuebench_cases::scene;
//! let text = r#"
//! title = "A soft block under its own weight"
//! body = { shape = "box", size = ["40 mm", "40 mm", "20 mm"] }
//! material = { law = "linear", young = "20 kPa", poisson = 0.45 }
//! support = [{ where = "z == 0 mm", fix = "xyz" }]
//! load = [{ body = ["0 N/m^3", "0 N/m^3", "-9.81 kN/m^3"] }]
//! method = [{ id = "tet10", family = "fem", element = "tet10", size = { level = 2 } }]
//! "#;
//! // What is read is in SI units; what is wrong is named with file, line, key and what would be right.
//! let scene = scene::parse(text, "block.toml").expect("sound");
//! assert_eq!(scene.methods[0].id, "tet10");
//! let errors = scene::parse(&text.replace("20 kPa", "20"), "block.toml").unwrap_err();
//! let message = errors[0].to_string();
//! assert!(message.starts_with("block.toml:4: ") && message.contains("a pressure needs a unit"), "{message}");
//! ```

pub mod exact;
pub mod import;
pub mod scene;
pub mod tissue;
