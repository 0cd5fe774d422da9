//! Turns the parts of a surface outwards. Parts within a part, cavities or bodies, keep their orientation
//! relative to it.

use crate::surface::change::Change;
use crate::surface::nested;
use crate::surface::orientation::consistent;
use crate::surface::sides::sides;
use crate::surface::soup::Soup;

/// Turns parts whose volume is negative, with the parts within them.
pub(super) fn turn(soup: &mut Soup) -> Option<Change> {
    let mut orientation = consistent(soup, &sides(soup));
    if orientation.parts > nested::MOST {
        return None;
    }
    let mut lists: Vec<Vec<usize>> = vec![Vec::new(); orientation.parts];
    orientation.part.iter().enumerate().for_each(|(t, part)| lists[*part as usize].push(t));
    let parts: Vec<Vec<[u32; 3]>> =
        lists.iter().map(|list| list.iter().map(|&t| soup.triangles[t]).collect()).collect();
    let middle = |part: usize| soup.points[parts[part][0][0] as usize];
    let is_around = |other: usize, part: usize| {
        other != part && nested::winding(&soup.points, &parts[other], &middle(part)).abs() > 0.5
    };
    // The outermost part around each part.
    let outermost = |part: usize| {
        let around: Vec<usize> = (0..parts.len()).filter(|&other| is_around(other, part)).collect();
        around.iter().copied().find(|&o| !around.iter().any(|&other| is_around(other, o))).unwrap_or(part)
    };
    let inwards: Vec<bool> = (0..parts.len())
        .map(|part| {
            let list = &lists[outermost(part)];
            let origin = soup.middle(list[0]);
            let corners = list.iter().map(|&t| soup.corners(t).map(|p| p - origin));
            corners.map(|[a, b, c]| a.dot(&b.cross(&c))).sum::<f64>() < 0.0
        })
        .collect();
    let places: Vec<_> = (0..parts.len()).filter(|&p| inwards[p]).map(|p| soup.middle(lists[p][0])).collect();
    orientation.turned.fill(false);
    orientation.turn_parts(&inwards);
    orientation.apply(soup);
    Change::at("reversed parts turned", places)
}
