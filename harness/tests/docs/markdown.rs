//! A page of Markdown: its fenced blocks with the comments before them, and the files that it refers to.

use std::path::PathBuf;

use crate::root;

/// A Markdown file.
pub struct Page {
    pub path: PathBuf,
    pub text: String,
    pub blocks: Vec<Block>,
}

/// A fenced block.
pub struct Block {
    /// Line of the opening fence, from 1.
    pub line: usize,
    /// First word after the fence.
    pub language: String,
    pub text: String,
    /// Text of the HTML comment on the line before, if there is one.
    pub comment: Option<String>,
}

impl Page {
    pub fn read(path: PathBuf) -> Page {
        let text = std::fs::read_to_string(&path).unwrap_or_else(|bad| panic!("{}: {bad}", path.display()));
        let blocks = blocks(&text);
        Page { path, text, blocks }
    }

    /// Path from the root of the workspace.
    pub fn name(&self) -> String {
        self.path.strip_prefix(root()).unwrap_or(&self.path).display().to_string()
    }

    pub fn has_commands(&self) -> bool {
        self.blocks.iter().any(Block::is_commands)
    }

    /// Relative paths in links, pictures and includes outside fenced blocks, and in includes within blocks.
    pub fn targets(&self) -> Vec<String> {
        let mut found = Vec::new();
        let mut fenced = false;
        for line in self.text.lines() {
            fenced ^= line.trim_start().starts_with("```");
            for part in line.split("{{#include ").skip(1) {
                let end = part.find([':', '}']).unwrap_or(part.len());
                found.push(part[..end].trim().to_string());
            }
            let links = line.split("](").skip(1).chain(line.split("src=\"").skip(1));
            for part in links.filter(|_| !fenced) {
                let target = part.split([')', '#', ' ', '"']).next().unwrap_or_default();
                if !target.is_empty() && !target.contains("://") {
                    found.push(target.to_string());
                }
            }
        }
        found
    }
}

impl Block {
    pub fn is_commands(&self) -> bool {
        matches!(self.language.as_str(), "sh" | "console")
    }

    /// File name in the first line of a scene or a curve, such as `# block.toml`.
    pub fn file(&self) -> Option<&str> {
        let name = self.text.lines().next()?.strip_prefix("# ")?;
        let kind = ["toml", "csv"].into_iter().find(|kind| self.language == *kind)?;
        (name.rsplit_once('.')?.1 == kind && !name.contains(' ')).then_some(name)
    }
}

fn blocks(text: &str) -> Vec<Block> {
    let mut found: Vec<Block> = Vec::new();
    let (mut open, mut comment) = (false, None);
    for (i, line) in text.lines().enumerate() {
        match (line.trim_start().strip_prefix("```"), open) {
            (Some(info), false) => {
                let language = info.split([' ', ',']).next().unwrap_or_default().to_string();
                found.push(Block { line: i + 1, language, text: String::new(), comment: comment.take() });
                open = true;
            }
            (Some(_), true) => open = false,
            (None, true) => {
                let block = found.last_mut().expect("open");
                block.text.push_str(line);
                block.text.push('\n');
            }
            (None, false) if line.trim().is_empty() => {}
            (None, false) => {
                let inside = line.trim().strip_prefix("<!--").and_then(|l| l.strip_suffix("-->"));
                comment = inside.map(|l| l.trim().to_string());
            }
        }
    }
    found
}
