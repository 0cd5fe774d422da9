//! Reader of versions 4.0 and 4.1 in text and binary, and of version 2 in binary, number by number.

use std::collections::HashMap;

use geometry::Point3;

use super::groups::{Names, named};
use super::order::{Element, element, known};
use super::scanner::Scanner;
use super::text2::add;
use crate::content::Content;
use crate::error::{Parsed, Place, Problem};
use crate::lines::Lines;
use crate::rows::Row;

/// Format version.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Version {
    /// Elements grouped by type, each with its physical tag.
    Two,
    /// Blocks of entities, with 32-bit tags.
    Four,
    /// Blocks of entities with 64-bit tags; all tags of a block come before its coordinates.
    FourOne,
}

/// Physical tags by dimension and tag of an entity.
type Entities = HashMap<(u64, i64), Vec<u64>>;

/// Smallest and largest number stated by a section, and the place of this statement.
type Claim = (Place, [u64; 2]);

/// Smallest and largest number so far.
#[derive(Clone, Copy, Default)]
struct Range(Option<[u64; 2]>);

impl Range {
    fn add(&mut self, number: u64) {
        let [least, largest] = self.0.unwrap_or([number; 2]);
        self.0 = Some([least.min(number), largest.max(number)]);
    }
}

struct Reader<'a> {
    scanner: Scanner<'a>,
    version: Version,
    binary: bool,
    names: Names,
    entities: Entities,
    content: Content,
}

pub(super) fn parse(bytes: &[u8], version: &str, binary: bool) -> Parsed<Content> {
    let version = match version {
        "4.1" => Version::FourOne,
        "4.0" | "4" => Version::Four,
        _ => Version::Two,
    };
    let mut reader = Reader {
        scanner: Scanner::new(bytes, binary),
        version,
        binary,
        names: Names::default(),
        entities: Entities::new(),
        content: Content::default(),
    };
    reader.sections()?;
    Ok(reader.content)
}

impl Reader<'_> {
    fn sections(&mut self) -> Parsed<()> {
        let other =
            |line: &String| line != "$MeshFormat" && line.starts_with('$') && !line.starts_with("$End");
        let mut first = self.scanner.line();
        while let Some(line) = first.filter(other) {
            self.scanner.skip(&line[1..])?;
            first = self.scanner.line();
        }
        self.scanner.line();
        if self.binary {
            self.scanner.byte_order()?;
        }
        self.scanner.exactly("$EndMeshFormat")?;
        let (mut nodes, mut elements) = (false, false);
        while let Some(line) = self.scanner.line() {
            match line.as_str() {
                "$PhysicalNames" => self.physical_names()?,
                "$Entities" => self.entities()?,
                "$Nodes" if nodes => return self.scanner.fail(Problem::Repeated { section: "$Nodes" }),
                "$Nodes" => {
                    self.nodes()?;
                    nodes = true;
                }
                "$Elements" if elements => {
                    return self.scanner.fail(Problem::Repeated { section: "$Elements" });
                }
                "$Elements" if !nodes => return self.scanner.fail(Problem::Missing { section: "$Nodes" }),
                "$Elements" => {
                    self.elements()?;
                    elements = true;
                }
                "$PartitionedEntities" => {
                    let help = "write the mesh without partitions (Mesh.SaveWithoutPartitions)";
                    return self.scanner.fail(Problem::Unread { what: line, help });
                }
                _ => match line.strip_prefix('$').filter(|name| !name.starts_with("End")) {
                    Some(name) => self.scanner.skip(name)?,
                    None => {
                        let found = line.chars().take(40).collect();
                        let expected = "the start of a section";
                        return self.scanner.fail(Problem::Expected { expected, found });
                    }
                },
            }
        }
        match (nodes, elements) {
            (false, _) => self.scanner.fail(Problem::Missing { section: "$Nodes" }),
            (_, false) => self.scanner.fail(Problem::Missing { section: "$Elements" }),
            _ if self.content.cell_count() == 0 => self.scanner.fail(Problem::NoCells),
            _ => Ok(()),
        }
    }

    /// Reads the physical names, which are text in binary files too.
    fn physical_names(&mut self) -> Parsed<()> {
        let expected = "the number of physical names";
        let Some(line) = self.scanner.line() else {
            return self.scanner.fail(Problem::End { expected });
        };
        let Ok(count) = line.parse::<u64>() else {
            return self.scanner.fail(Problem::Expected { expected, found: line });
        };
        for _ in 0..count {
            let Some(line) = self.scanner.line() else {
                return self.scanner.fail(Problem::End { expected: "a physical name" });
            };
            let place = self.scanner.place();
            let name = named(&Lines::new(""), &line).map_err(|(_, problem)| (place, problem))?;
            self.names.add(&mut self.content, place, name)?;
        }
        self.scanner.exactly("$EndPhysicalNames")
    }

    /// Reads the physical groups of points, curves, surfaces and volumes.
    fn entities(&mut self) -> Parsed<()> {
        self.scanner.behind_line();
        let mut counts = [0; 4];
        for (dimension, count) in counts.iter_mut().enumerate() {
            let claimed = self.scanner.size("a number of entities")?;
            let least = if dimension == 0 && self.version == Version::FourOne { 36 } else { 60 };
            *count = self.scanner.counted(claimed, least, "entities")?;
        }
        for (dimension, count) in counts.into_iter().enumerate() {
            for _ in 0..count {
                let tag = self.scanner.int("the tag of an entity")?;
                let point = dimension == 0 && self.version == Version::FourOne;
                for _ in 0..if point { 3 } else { 6 } {
                    self.scanner.real("a corner of an entity")?;
                }
                let groups = self.list("the physical tags of an entity")?;
                let groups = groups.into_iter().map(|tag| tag.unsigned_abs()).collect();
                self.entities.insert((dimension as u64, tag), groups);
                if dimension > 0 {
                    self.list("the borders of an entity")?;
                }
            }
        }
        self.scanner.exactly("$EndEntities")
    }

    /// Reads a count followed by as many integers.
    fn list(&mut self, expected: &'static str) -> Parsed<Vec<i64>> {
        let claimed = self.scanner.size(expected)?;
        let count = self.scanner.counted(claimed, 4, "tags of an entity")?;
        (0..count).map(|_| self.scanner.int(expected)).collect()
    }

    fn nodes(&mut self) -> Parsed<()> {
        if self.version == Version::Two {
            let count = self.count_line("the number of nodes")?;
            for _ in 0..self.scanner.counted(count, 28, "nodes")? {
                self.node()?;
            }
            return self.scanner.exactly("$EndNodes");
        }
        self.scanner.behind_line();
        let wide = self.version == Version::FourOne;
        let blocks = self.scanner.size("the number of blocks of nodes")?;
        let blocks = self.scanner.counted(blocks, 20, "blocks of nodes")?;
        let (claimed, claimed_range) = self.totals("the number of nodes")?;
        let mut range = Range::default();
        for _ in 0..blocks {
            // Dimension and tag of the entity, in an order that depends on the version.
            let [first, second, parametric] = self.ints("the head of a block of nodes")?;
            let dimension = if wide { first } else { second };
            let count = self.scanner.size("the number of nodes of a block")?;
            let count = self.scanner.counted(count, 28, "nodes")?;
            if !wide {
                for _ in 0..count {
                    self.node()?;
                    self.parameters(parametric, dimension)?;
                }
                continue;
            }
            let tags: Vec<u64> =
                (0..count).map(|_| self.scanner.size("a node number")).collect::<Parsed<_>>()?;
            tags.iter().for_each(|&number| range.add(number));
            for number in tags {
                let at = self.point()?;
                self.content.node(self.scanner.place(), number, at)?;
                self.parameters(parametric, dimension)?;
            }
        }
        self.whole("nodes", claimed, self.content.node_count())?;
        self.within("nodes", claimed_range, range)?;
        self.scanner.exactly("$EndNodes")
    }

    /// Reads the total number in all blocks, and in version 4.1 the smallest and largest number.
    fn totals(&mut self, expected: &'static str) -> Parsed<(u64, Option<Claim>)> {
        let claimed = self.scanner.size(expected)?;
        if self.version != Version::FourOne {
            return Ok((claimed, None));
        }
        let range = [self.scanner.size("the least number")?, self.scanner.size("the largest number")?];
        Ok((claimed, Some((self.scanner.place(), range))))
    }

    /// Rejects numbers that differ from the stated range.
    fn within(&self, what: &'static str, claimed: Option<Claim>, Range(found): Range) -> Parsed<()> {
        match (claimed, found) {
            (Some((place, claimed)), Some(found)) if claimed != found => {
                Err((place, Problem::Range { what, claimed, found }))
            }
            _ => Ok(()),
        }
    }

    /// Rejects blocks whose total differs from the stated count.
    fn whole(&self, what: &'static str, claimed: u64, found: usize) -> Parsed<()> {
        if claimed == found as u64 {
            Ok(())
        } else {
            self.scanner.fail(Problem::Count { what, claimed, found })
        }
    }

    /// Reads the number and position of a node.
    fn node(&mut self) -> Parsed<()> {
        let number = self.scanner.tag(false, "a node number")?;
        let at = self.point()?;
        self.content.node(self.scanner.place(), number, at)
    }

    fn point(&mut self) -> Parsed<Point3> {
        let mut at = Point3::origin();
        for d in 0..3 {
            at[d] = self.scanner.real("a coordinate")?;
        }
        Ok(at)
    }

    /// Skips parametric coordinates on a curve or surface, which may follow the position of a node.
    fn parameters(&mut self, parametric: i64, dimension: i64) -> Parsed<()> {
        for _ in 0..if parametric == 0 { 0 } else { dimension.clamp(0, 3) } {
            self.scanner.real("a parametric coordinate")?;
        }
        Ok(())
    }

    fn ints(&mut self, expected: &'static str) -> Parsed<[i64; 3]> {
        Ok([self.scanner.int(expected)?, self.scanner.int(expected)?, self.scanner.int(expected)?])
    }

    /// Reads a count in a line of text, which precedes binary numbers in version 2.
    fn count_line(&mut self, expected: &'static str) -> Parsed<u64> {
        let found = self.scanner.line();
        let count = found.as_deref().map(str::parse);
        match (count, found) {
            (Some(Ok(count)), _) => {
                self.scanner.behind_line();
                Ok(count)
            }
            (_, Some(found)) => self.scanner.fail(Problem::Expected { expected, found }),
            (_, None) => self.scanner.fail(Problem::End { expected }),
        }
    }

    fn elements(&mut self) -> Parsed<()> {
        if self.version == Version::Two {
            return self.elements_by_type();
        }
        self.scanner.behind_line();
        let wide = self.version == Version::FourOne;
        let blocks = self.scanner.size("the number of blocks of elements")?;
        let blocks = self.scanner.counted(blocks, 20, "blocks of elements")?;
        let (claimed, claimed_range) = self.totals("the number of elements")?;
        let mut range = Range::default();
        for _ in 0..blocks {
            let [first, second, kind] = self.ints("the head of a block of elements")?;
            let (dimension, tag) = if wide { (first, second) } else { (second, first) };
            let of_kind = u64::try_from(kind).ok().and_then(element).map(Element::dimension);
            if let Some(own) = of_kind.filter(|own| *own != dimension) {
                return self.scanner.fail(Problem::Dimension { entity: dimension, kind, dimension: own });
            }
            let count = self.scanner.size("the number of elements of a block")?;
            let count = self.scanner.counted(count, 8, "elements")?;
            let groups = self.entities.get(&(dimension.unsigned_abs(), tag)).cloned().unwrap_or_default();
            for _ in 0..count {
                let number = self.scanner.tag(wide, "an element number")?;
                range.add(number);
                self.element(number, kind, &groups, wide)?;
            }
        }
        self.whole("elements", claimed, self.content.element_count())?;
        self.within("elements", claimed_range, range)?;
        self.scanner.exactly("$EndElements")
    }

    /// Reads version 2 blocks, each with a head of type, number of elements and number of tags.
    fn elements_by_type(&mut self) -> Parsed<()> {
        self.content.repeat_cells();
        let all = self.count_line("the number of elements")?;
        let mut left = self.scanner.counted(all, 8, "elements")?;
        while left > 0 {
            let [kind, count, tags] = self.ints("the head of elements of one type")?;
            let count = usize::try_from(count).ok().filter(|count| (1..=left).contains(count));
            let (Some(count), 0..=64) = (count, tags) else {
                let expected = "no more elements than the section has, and few tags";
                return self
                    .scanner
                    .fail(Problem::Expected { expected, found: format!("{count:?}, {tags} tags") });
            };
            for _ in 0..count {
                let number = self.scanner.tag(false, "an element number")?;
                let mut group = 0;
                for tag in 0..tags {
                    let value = self.scanner.int("a tag")?;
                    if tag == 0 {
                        group = value.unsigned_abs();
                    }
                }
                self.element(number, kind, &[group], false)?;
            }
            left -= count;
        }
        self.scanner.exactly("$EndElements")
    }

    /// Reads the nodes of an element.
    fn element(&mut self, number: u64, kind: i64, groups: &[u64], wide: bool) -> Parsed<()> {
        let row = Row { place: self.scanner.place(), tag: number };
        let Some(element) = u64::try_from(kind).ok().and_then(element) else {
            let kind = kind.to_string();
            return self.scanner.fail(Problem::UnknownType { element: number, kind, known: known() });
        };
        let mut list = [0; 20];
        let list = &mut list[..Element::node_count(element)];
        for node in list.iter_mut() {
            *node = self.scanner.tag(wide, "a node number")?;
        }
        add(&mut self.content, &self.names, row, element, groups, list)
    }
}
