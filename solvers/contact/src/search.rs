//! Contact search over many small steps.
//!
//! Points that can touch before the body or the tool has moved by a margin are listed once, and only these
//! are processed until then (Verlet, Phys. Rev. 159 (1967), 98-103). A point that is farther from a tool than
//! the margin cannot touch the tool while both together have moved by less. In explicit steps of a micrometre
//! a list lasts for some hundreds of steps. Without lists, a step of the published ramp processed 191 points
//! and built 256 boxes around clusters for 17 points in contact, which took a fifth of its time.

use shape::Vector3;

use crate::contacts::Contacts;
use crate::error::ContactError;
use crate::evaluate::ContactCounts;
use crate::history::ContactHistory;
use crate::surface::{CLUSTER, ContactSurface};
use crate::tool::Tool;

/// Margin over the mean distance between points. A larger margin keeps a list for longer, with more points in
/// it.
const MARGIN: f64 = 0.125;
/// Part of the margin reserved for rounding: enough for bodies that are a hundred million margins away from
/// the origin.
const ROUNDING: f64 = 1e-6;

/// Contact search for the same tools in successive states. The contacts have the same bits as those of
/// [`ContactSurface::tractions`], whatever the earlier states.
#[derive(Clone, Debug)]
pub struct ContactSearch<'a> {
    surface: &'a ContactSurface<'a>,
    /// Nodes of the surface, each once.
    nodes: Vec<u32>,
    /// Displacements (m) of these nodes in the state of the lists.
    listed_at: Vec<Vector3>,
    /// Counter of the states in which lists were made; a list of an earlier state is out of date.
    state: u64,
    lists: Vec<List>,
    /// Margin, m.
    margin: f64,
    /// Bound of a point's motion over the largest change of a component of a nodal displacement.
    stretch: f64,
}

/// Points that may touch one tool.
#[derive(Clone, Debug)]
struct List {
    state: u64,
    points: Vec<u32>,
    /// Closure of the tool when the list was made, m.
    closure: f64,
    /// Gap up to which a point with a multiplier touches, m.
    reach: f64,
    /// Largest change of a gap per travel of the tool while the list serves.
    rate: f64,
}

impl<'a> ContactSearch<'a> {
    /// Prepares a search for the contacts of a surface with a number of `tools`, which are numbered from 0.
    pub fn new(surface: &'a ContactSurface<'a>, tools: usize) -> ContactSearch<'a> {
        let mut nodes = surface.nodes.clone();
        nodes.sort_unstable();
        nodes.dedup();
        let rows = surface.rows();
        let area: f64 = rows.weights().iter().sum();
        let spacing = (area / rows.points().len().max(1) as f64).sqrt();
        ContactSearch {
            listed_at: vec![Vector3::zeros(); nodes.len()],
            nodes,
            state: 0,
            lists: vec![List { state: 0, points: Vec::new(), closure: 0.0, reach: 0.0, rate: 1.0 }; tools],
            margin: MARGIN * spacing,
            stretch: 3.0f64.sqrt() * surface.lebesgue(),
            surface,
        }
    }

    /// Starts the search of all tools in the state `u` (m, one vector per node). It is called once per state,
    /// followed by [`SearchAt::tractions`] for each tool.
    pub fn at<'s>(&'s mut self, u: &'s [Vector3]) -> SearchAt<'s, 'a> {
        let moved = self.stretch * self.largest_change(u);
        SearchAt { search: self, u, moved }
    }

    /// Returns the largest change of a component since the lists were made, m; infinite if a change is NaN.
    fn largest_change(&self, u: &[Vector3]) -> f64 {
        if u.len() != self.surface.rows().rows().node_count() {
            return f64::INFINITY;
        }
        // Four nodes are processed side by side, so that none waits for another. A maximum ignores a NaN, a
        // sum does not.
        let (mut most, mut finite) = ([0.0f64; 12], [0.0; 12]);
        let (fours, rest) = self.nodes.as_chunks::<4>();
        let (before, rest_before) = self.listed_at.as_chunks::<4>();
        let mut look = |k: usize, node: u32, before: &Vector3| {
            let change = u[node as usize] - before;
            for a in 0..3 {
                let (most, finite) = (&mut most[3 * k + a], &mut finite[3 * k + a]);
                let change = change[a].abs();
                *finite += 0.0 * change;
                *most = if change > *most { change } else { *most };
            }
        };
        for (nodes, before) in fours.iter().zip(before) {
            (0..4).for_each(|k| look(k, nodes[k], &before[k]));
        }
        rest.iter().zip(rest_before).for_each(|(&node, before)| look(0, node, before));
        if finite == [0.0; 12] { most.into_iter().fold(0.0, f64::max) } else { f64::INFINITY }
    }
}

/// Search of a [`ContactSearch`] in one state.
#[derive(Debug)]
pub struct SearchAt<'s, 'a> {
    search: &'s mut ContactSearch<'a>,
    u: &'s [Vector3],
    /// Largest possible motion of any point since the lists were made, m.
    moved: f64,
}

impl SearchAt<'_, '_> {
    /// Evaluates as [`ContactSurface::tractions`], for the tool with this number (from 0). A tool must keep
    /// its number in every state.
    ///
    /// # Errors
    ///
    /// As [`ContactSurface::evaluate`].
    pub fn tractions(
        &mut self,
        number: usize,
        tool: &Tool,
        closure: f64,
        history: &ContactHistory,
        counts: &mut ContactCounts,
    ) -> Result<Option<Contacts>, ContactError> {
        let surface = self.search.surface;
        let u = self.u;
        let reach = surface.reach(tool, closure, u, history, counts)?;
        if !self.serves(number, closure, reach) {
            self.list(number, tool, closure, reach)?;
        }
        let near: Vec<&[u32]> = self.search.lists[number].points.chunks(CLUSTER).collect();
        let found = surface.scan(tool, closure, u, history, counts, &near, |_, _, _, _| ())?;
        Ok(found.map(|found| Contacts::new(surface, tool, closure, u, found, Vec::new())))
    }

    fn serves(&self, number: usize, closure: f64, reach: f64) -> bool {
        let ContactSearch { state, margin, lists, .. } = &*self.search;
        let list = &lists[number];
        let moved = self.moved + list.rate * (closure - list.closure).abs();
        // A NaN must not pass, hence `moved <= ..`. The first state is 1.
        *state > 0 && list.state == *state && reach <= list.reach && moved <= (1.0 - ROUNDING) * margin
    }

    fn list(&mut self, number: usize, tool: &Tool, closure: f64, reach: f64) -> Result<(), ContactError> {
        let search = &mut *self.search;
        let u = self.u;
        let surface = search.surface;
        let far = reach + search.margin;
        let near = surface.near(tool, closure, far, u)?;
        // Lists of other tools from an earlier state are out of date from here on.
        if search.state == 0 || self.moved != 0.0 {
            search.listed_at.iter_mut().zip(&search.nodes).for_each(|(to, &node)| *to = u[node as usize]);
            search.state += 1;
            self.moved = 0.0;
        }
        let list = &mut search.lists[number];
        // Points may move away from an axis by the margin while the list serves.
        let positions = (0..surface.rows().points().len()).map(|q| surface.position(q, u));
        let rate = tool.rate(positions, search.margin);
        let may = |&q: &u32| tool.gap(closure, &surface.position(q as usize, u)) <= far;
        list.points.clear();
        list.points.extend(near.iter().copied().flatten().copied().filter(may));
        (list.state, list.closure, list.reach, list.rate) = (search.state, closure, reach, rate);
        Ok(())
    }
}
