//! Bodies in three dimensions: one element of the page for each case, parsed on demand.

use records::{BodyState, Faces, RecordedBody, SurfaceField};
use serde::Serialize;

use crate::error::ReportError;
use crate::select::Run;

/// Script that draws the bodies, evaluated on first use.
const SCRIPT: &str = include_str!("../../page/built/solid.js");

/// Bytes for all bodies of a page, which keep the page of the whole verification below 8 MB.
const ROOM: usize = 3_400_000;
/// Fraction of the room above which a body with a coarser sibling of the same method is omitted, before load
/// steps of other bodies are.
const LARGE: f64 = 0.05;

#[derive(Clone, Serialize)]
struct BodyView<'a> {
    case: &'a str,
    method: &'a str,
    title: &'a str,
    /// Method of an earlier body with the same points and faces, which are not repeated.
    #[serde(skip_serializing_if = "Option::is_none")]
    like: Option<&'a str>,
    /// Method of an earlier body with the same tools.
    #[serde(skip_serializing_if = "Option::is_none")]
    tools_like: Option<&'a str>,
    #[serde(flatten)]
    body: RecordedBody,
    /// Series of the method's sizes.
    #[serde(skip)]
    series: &'a str,
    /// Methods whose bodies have no room; stored with the first body of a case.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    without: Vec<&'a str>,
}

impl BodyView<'_> {
    fn size(&self) -> usize {
        let RecordedBody { points, faces, off, source, cloud, tools, states, .. } = &self.body;
        let fixed = points.len() + off.len() + source.len() + cloud.len() + of_faces(faces);
        let tools: usize = tools.iter().map(|t| t.points.len() + t.quads.len()).sum();
        fixed + tools + states.iter().map(of_state).sum::<usize>() + self.inside()
    }

    /// Size of the data that only a cut shows.
    fn inside(&self) -> usize {
        self.body.inside.as_ref().map_or(0, |inside| {
            let states = inside.states.iter().map(|s| s.u.len() + of_values(&s.values));
            inside.points.len() + of_faces(&inside.cells) + states.sum::<usize>()
        })
    }

    /// Size with only the last state.
    fn least(&self) -> usize {
        let states = &self.body.states;
        self.size() - self.inside() - states[..states.len() - 1].iter().map(of_state).sum::<usize>()
    }
}

fn of_state(state: &BodyState) -> usize {
    state.u.len() + state.touching.len() + of_values(&state.values)
}

fn of_values(values: &Option<[String; 3]>) -> usize {
    values.as_ref().map_or(0, |values| values.iter().map(String::len).sum())
}

fn of_faces(faces: &[Faces]) -> usize {
    faces.iter().map(|f| f.indices.len()).sum()
}

/// HTML elements of the bodies; empty for results without bodies.
pub(super) fn elements(fields: &[SurfaceField], runs: &[Run]) -> Result<String, ReportError> {
    let view = |f: &'_ SurfaceField| f.body.clone().filter(|b| !b.states.is_empty());
    let mut bodies: Vec<BodyView> = fields
        .iter()
        .filter_map(|f| {
            let run = runs.iter().find(|r| r.is.case == f.case && r.is.method == f.method);
            Some(BodyView {
                case: &f.case,
                method: &f.method,
                title: &f.title,
                like: None,
                tools_like: None,
                body: view(f)?,
                series: run.map_or(&f.method, |run| &run.is.series),
                without: Vec::new(),
            })
        })
        .collect();
    bodies.sort_by_key(|b| runs.iter().position(|r| r.is.case == b.case && r.is.method == b.method));
    share(&mut bodies);
    let all: Vec<(&str, &str)> = bodies.iter().map(|b| (b.case, b.method)).collect();
    fit(&mut bodies, ROOM);
    bodies.sort_by_key(|b| b.case);
    for of_case in bodies.chunk_by_mut(|a, b| a.case == b.case) {
        let lost = all.iter().filter(|(case, method)| {
            *case == of_case[0].case && !of_case.iter().any(|kept| kept.method == *method)
        });
        of_case[0].without = lost.map(|(_, method)| *method).collect();
    }
    let mut out = String::new();
    for case in bodies.chunk_by(|a, b| a.case == b.case) {
        let json = serde_json::to_string(case).map_err(ReportError::Page)?.replace('<', "\\u003c");
        let name = case[0].case.replace('&', "&amp;").replace('"', "&quot;");
        out += &format!("<script type=\"application/json\" id=\"bodies-{name}\">{json}</script>\n");
    }
    if !out.is_empty() {
        out += &format!("<script type=\"text/plain\" id=\"solid\">{SCRIPT}</script>\n");
    }
    Ok(out)
}

/// Removes repeated data. Methods on one mesh share a surface, and all methods of a scene share the tools:
/// only the first body of a case keeps these.
fn share(bodies: &mut [BodyView]) {
    for k in 1..bodies.len() {
        let (before, rest) = bodies.split_at_mut(k);
        let own = &mut rest[0];
        let first = |same: fn(&RecordedBody, &RecordedBody) -> bool| {
            before.iter().find(|b| b.case == own.case && same(&b.body, &own.body)).map(|b| b.method)
        };
        let like = first(|a, b| a.points == b.points && a.faces == b.faces);
        let tools_like = first(|a, b| !a.tools.is_empty() && a.tools == b.tools);
        if like.is_some() {
            own.body.points.clear();
            own.body.faces.clear();
            // The same surface implies the same mesh.
            if let Some(inside) = &mut own.body.inside {
                inside.points.clear();
                inside.cells.clear();
            }
        }
        if tools_like.is_some() {
            own.body.tools.clear();
        }
        (own.like, own.tools_like) = (like, tools_like);
    }
}

/// Reduces the bodies to the available room. Large bodies with a coarser sibling are removed first, then cut
/// data of the largest bodies, then states of the largest bodies except the last, and finally the largest
/// bodies.
fn fit(bodies: &mut Vec<BodyView>, room: usize) {
    while bodies.iter().map(BodyView::size).sum::<usize>() > room {
        let others = |b: &BodyView, is: &dyn Fn(&BodyView) -> bool| {
            bodies.iter().any(|o| o.case == b.case && o.method != b.method && is(o))
        };
        let needed = |b: &BodyView| others(b, &|o| [o.like, o.tools_like].contains(&Some(b.method)));
        let can_go = |b: &BodyView| {
            b.least() as f64 > LARGE * room as f64
                && others(b, &|o| o.series == b.series && o.least() < b.least())
        };
        let largest = |takes: &dyn Fn(&BodyView) -> bool| {
            let taken = bodies.iter().enumerate().filter(|(_, b)| takes(b));
            taken.max_by_key(|(k, b)| (b.size(), std::cmp::Reverse(*k))).map(|(k, _)| k)
        };
        let large = largest(&|b| !needed(b) && can_go(b));
        let inner = bodies.iter().enumerate().filter(|(_, b)| b.inside() > 0);
        let inner = inner.max_by_key(|(k, b)| (b.inside(), std::cmp::Reverse(*k))).map(|(k, _)| k);
        let moving = largest(&|b| b.body.states.len() > 1);
        let any = largest(&|b| !needed(b));
        match (large, inner, moving, any) {
            (None, Some(k), _, _) => {
                let case = bodies[k].case;
                let method = bodies[k].like.unwrap_or(bodies[k].method);
                let alike = |b: &&mut BodyView| b.case == case && b.like.unwrap_or(b.method) == method;
                bodies.iter_mut().filter(alike).for_each(|b| b.body.inside = None);
            }
            (None, None, Some(k), _) => {
                let body = &mut bodies[k].body;
                let gone = body.states.len() - 1;
                body.states.drain(..gone);
                body.left_out += gone;
            }
            (Some(k), ..) | (None, None, None, Some(k)) => drop(bodies.remove(k)),
            (None, None, None, None) => break,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use records::{Inside, InsideState, pack};

    fn body_view(case: &'static str, method: &'static str, body: RecordedBody) -> BodyView<'static> {
        BodyView {
            case,
            method,
            title: "",
            like: None,
            tools_like: None,
            body,
            series: method,
            without: Vec::new(),
        }
    }

    #[test]
    fn what_has_no_room_is_left_out_and_counted() {
        let view = |method: &'static str, points: usize| {
            let state = || BodyState { u: pack(vec![0f32; 3 * points]), ..BodyState::default() };
            let body = RecordedBody {
                points: pack(vec![0f32; 3 * points]),
                states: vec![state(), state(), state()],
                ..RecordedBody::default()
            };
            body_view("a", method, body)
        };
        let fitted = |room: usize| -> Vec<(&str, usize, usize)> {
            let mut all = vec![view("small", 10), view("large", 100)];
            fit(&mut all, room);
            all.iter().map(|b| (b.method, b.body.states.len(), b.body.left_out)).collect()
        };
        // Points take 160 bytes, and states 1600 bytes.
        assert_eq!(fitted(7040), [("small", 3, 0), ("large", 3, 0)]);
        assert_eq!(fitted(7039), [("small", 3, 0), ("large", 1, 2)]);
        assert_eq!(fitted(3839), [("small", 1, 2), ("large", 1, 2)]);
        assert_eq!(fitted(3000), [("small", 1, 2)]);
        // A fine mesh is omitted before load steps of a coarser mesh.
        let mut all = vec![view("coarse", 10), view("fine", 100)];
        all.iter_mut().for_each(|b| b.series = "one");
        fit(&mut all, 3839);
        assert_eq!(all.iter().map(|b| (b.method, b.body.states.len())).collect::<Vec<_>>(), [("coarse", 3)]);
    }

    #[test]
    fn what_only_a_cut_shows_goes_first_and_with_all_that_share_it() {
        let view = |method: &'static str| {
            let inside = Inside {
                points: pack(vec![0f32; 300]),
                states: vec![InsideState::default()],
                ..Inside::default()
            };
            let states = vec![BodyState::default()];
            body_view(
                "a",
                method,
                RecordedBody {
                    points: pack(vec![0f32; 3]),
                    states,
                    inside: Some(inside),
                    ..RecordedBody::default()
                },
            )
        };
        let mut all = vec![view("tet4"), view("tet4-nodal")];
        share(&mut all);
        assert_eq!((all[0].inside(), all[1].inside()), (1600, 0));
        fit(&mut all, 1000);
        assert_eq!(all.len(), 2);
        assert!(all.iter().all(|b| b.body.inside.is_none()));
    }

    #[test]
    fn methods_on_one_mesh_share_their_surface() {
        let view = |case: &'static str, method: &'static str, points: usize| {
            let states = vec![BodyState { u: pack(vec![1f32; 3 * points]), ..BodyState::default() }];
            let body =
                RecordedBody { points: pack(vec![0f32; 3 * points]), states, ..RecordedBody::default() };
            body_view(case, method, body)
        };
        let mut all =
            vec![view("a", "tet4", 10), view("a", "tet10", 20), view("a", "efg", 10), view("b", "tet4", 10)];
        share(&mut all);
        let likes: Vec<_> = all.iter().map(|b| (b.like, b.body.points.is_empty())).collect();
        assert_eq!(likes, [(None, false), (None, false), (Some("tet4"), true), (None, false)]);
        // A surface that another body needs is kept.
        fit(&mut all, 700);
        assert_eq!(all.iter().map(|b| (b.case, b.method)).collect::<Vec<_>>(), [("a", "tet4"), ("a", "efg")]);
    }
}
