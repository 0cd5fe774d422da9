use lanes::LanePath;

use super::fill::fill_gradients;
use super::*;

#[test]
fn wide_registers_and_the_company_in_a_group_leave_the_bits_alone() {
    let nodes: Vec<Point3> = (0..216)
        .map(|i| Point3::new((i % 6) as f64, (i / 6 % 6) as f64 + 0.1 * (i % 5) as f64, (i / 36) as f64))
        .collect();
    // Every sixteenth point lies just beyond all supports and needs the remedies; its neighbours in the list
    // do not.
    let at = |q: usize| {
        let x = Point3::new(0.077, 0.053, 0.061) * q as f64 + Vector3::repeat(0.1);
        if q % 16 == 7 { Point3::new(7.7, x.y, x.z) } else { x }
    };
    let points: Vec<Point3> = (0..64).map(at).collect();
    let radii: Vec<f64> = (0..216).map(|i| 2.6 + 0.01 * (i % 7) as f64).collect();
    for kernel in Kernel::all() {
        for basis in Basis::ALL {
            let mls = Approximation::new(nodes.clone(), radii.clone(), kernel, basis).unwrap();
            let mut plain = Chunk::default();
            mls.fill_plain::<true>(&points, &mut plain).unwrap();
            assert!(plain.rows.values.len() > 640);
            assert!(plain.outcomes.iter().enumerate().all(|(q, o)| o.enlarged == (q % 16 == 7)));
            let mut alone = Chunk::default();
            let mut one_by_one = Chunk::default();
            for x in &points {
                mls.fill_plain::<true>(&[*x], &mut alone).unwrap();
                one_by_one.rows.append(&alone.rows);
                one_by_one.outcomes.extend_from_slice(&alone.outcomes);
            }
            let mut others = vec![("one by one", one_by_one)];
            for path in LanePath::available() {
                let mut chunk = Chunk::default();
                fill_gradients(path, &mls, &points, &mut chunk).unwrap();
                others.push((path.name(), chunk));
            }
            for (path, Chunk { rows, outcomes, .. }) in &others {
                let label = format!("{path} {} {}", kernel.name(), basis.name());
                assert!(rows.offsets == plain.rows.offsets && rows.nodes == plain.rows.nodes, "{label}");
                assert!(rows.values == plain.rows.values && rows.grads == plain.rows.grads, "{label}");
                assert_eq!(*outcomes, plain.outcomes, "{label}");
            }
        }
    }
}
