//! Properties shared by every element and every face.

use geometry::CellKind;
use geometry::element::{Element, with_element};
use proptest::prelude::*;

use crate::face::{Face, into_cell, with_face};

/// Maps three numbers in (0, 1) to a point inside the reference cell of a kind.
fn inside(kind: CellKind, r: [f64; 3]) -> [f64; 3] {
    let corners = &kind.entry().nodes[..kind.corner_count()];
    // Trilinear weights of a cube's corners, dealt to the corners of the cell.
    let weight = |k: usize| (0..3).map(|i| if k >> i & 1 == 0 { 1.0 - r[i] } else { r[i] }).product::<f64>();
    let mut xi = [0.0; 3];
    for k in 0..8 {
        (0..3).for_each(|i| xi[i] += weight(k) * corners[k % corners.len()][i]);
    }
    xi
}

fn monomials(order: usize, x: [f64; 3]) -> Vec<f64> {
    let mut all = Vec::new();
    for i in 0..=order as i32 {
        for j in 0..=order as i32 - i {
            for k in 0..=order as i32 - i - j {
                all.push(x[0].powi(i) * x[1].powi(j) * x[2].powi(k));
            }
        }
    }
    all
}

#[test]
fn shape_functions_are_one_at_their_node_and_zero_at_the_others() {
    for kind in CellKind::ALL {
        with_element!(kind, E, N => {
            assert_eq!(N, kind.node_count());
            for (b, &xi) in E::NODES.iter().enumerate() {
                for (a, value) in E::shape(xi).into_iter().enumerate() {
                    assert_eq!(value, if a == b { 1.0 } else { 0.0 }, "{} N_{a} at node {b}", kind.name());
                }
            }
        });
    }
}

#[test]
fn node_coordinates_follow_the_topology_of_the_kind() {
    for kind in CellKind::ALL {
        let (nodes, cell) = (kind.entry().nodes, kind.entry().cell);
        if kind.order() == 2 {
            for (middle, &[a, b]) in (kind.corner_count()..).zip(kind.edges()) {
                for i in 0..3 {
                    assert_eq!(
                        nodes[middle][i],
                        0.5 * (nodes[a][i] + nodes[b][i]),
                        "{} {middle}",
                        kind.name()
                    );
                }
            }
        }
        assert!(nodes.iter().all(|&xi| (cell.excess)(xi) == 0.0));
        assert!((cell.excess)(cell.centre) < 0.0);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_element_holds_the_list(r in prop::array::uniform3(0.0..1.0_f64)) {
        for kind in CellKind::ALL {
            let xi = inside(kind, r);
            prop_assert!((kind.entry().cell.excess)(xi) <= 1e-15);
            with_element!(kind, E, N => {
                let (n, dn) = (E::shape(xi), E::shape_grad(xi));
                // Partition of unity: 20 terms of size 1, with a few last bits of error each.
                prop_assert!((n.iter().sum::<f64>() - 1.0).abs() < 1e-14);
                for k in 0..3 {
                    prop_assert!(dn.iter().map(|d| d[k]).sum::<f64>().abs() < 1e-13);
                }
                // Gradients: central differences of cubics with step h err by h^2 |N'''| / 6 + eps / h <
                // 1e-9.
                let h = 1e-5;
                for k in 0..3 {
                    let (mut up, mut down) = (xi, xi);
                    (up[k], down[k]) = (xi[k] + h, xi[k] - h);
                    let (up, down) = (E::shape(up), E::shape(down));
                    for a in 0..N {
                        let difference = (up[a] - down[a]) / (2.0 * h);
                        prop_assert!((difference - dn[a][k]).abs() < 1e-9, "{} dN_{a}/d{k}", kind.name());
                    }
                }
                // Complete polynomials of the kind's order.
                let exact = monomials(kind.order(), xi);
                let at_nodes: Vec<_> = E::NODES.iter().map(|&x| monomials(kind.order(), x)).collect();
                for m in 0..exact.len() {
                    let found: f64 = (0..N).map(|a| n[a] * at_nodes[a][m]).sum();
                    prop_assert!((found - exact[m]).abs() < 1e-14, "{} monomial {m}", kind.name());
                }
            });
        }
    }

    #[test]
    fn an_element_is_its_face_element_on_every_face(r in prop::array::uniform2(0.0..1.0_f64)) {
        for kind in CellKind::ALL {
            for (face, local) in kind.faces().iter().enumerate() {
                let face_kind = kind.face_kind(face);
                let s =
                    if face_kind.is_triangle() { [r[0], r[1] * (1.0 - r[0])] } else { r.map(|r| 2.0 * r - 1.0) };
                let xi = into_cell(kind, face, s);
                prop_assert!((kind.entry().cell.excess)(xi).abs() < 1e-15);
                let mut on_face = vec![0.0; kind.node_count()];
                with_face!(face_kind, F, N => {
                    for (&node, n) in local.iter().zip(F::shape(s)) {
                        on_face[node] = n;
                    }
                    for (&node, &s) in local.iter().zip(&F::NODES) {
                        prop_assert_eq!(into_cell(kind, face, s), kind.entry().nodes[node]);
                    }
                    let h = 1e-5;
                    for k in 0..2 {
                        let (mut up, mut down) = (s, s);
                        (up[k], down[k]) = (s[k] + h, s[k] - h);
                        let (up, down) = (F::shape(up), F::shape(down));
                        for (a, d) in F::shape_grad(s).iter().enumerate() {
                            prop_assert!(((up[a] - down[a]) / (2.0 * h) - d[k]).abs() < 1e-9);
                        }
                    }
                    prop_assert_eq!(N, local.len());
                });
                with_element!(kind, E, N => {
                    let n: [f64; N] = E::shape(xi);
                    for a in 0..N {
                        prop_assert!((n[a] - on_face[a]).abs() < 1e-15, "{} face {face} N_{a}", kind.name());
                    }
                });
            }
        }
    }
}
